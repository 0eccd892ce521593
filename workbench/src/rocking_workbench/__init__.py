"""The local web application: a JSON API over the package, and pages that call it."""
