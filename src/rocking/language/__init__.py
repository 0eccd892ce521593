"""Words of reports in several languages: one file of sentences for each, which say the same with the same numbers."""

from rocking.language._language import LANGUAGES, Language, language

__all__ = ["LANGUAGES", "Language", "language"]
