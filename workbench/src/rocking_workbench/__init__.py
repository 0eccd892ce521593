"""The local web application: a JSON API of the package, and pages that use this API."""
