"""Version of the package."""

__version__ = "0.1.0"

SOFTWARE = f"rocking {__version__}"
