"""The search of the manual takes questions as people ask them: words that only ask are not looked for."""

from sphinx.application import Sphinx
from sphinx.search.en import SearchEnglish

ASKING = (
    "how do i does did which what where when why who can could should my me you your give gives given get use want need"
)


class Questions(SearchEnglish):
    """English, without the words of a question."""

    stopwords = SearchEnglish.stopwords | frozenset(ASKING.split())


def setup(app: Sphinx) -> dict[str, bool]:
    """Tell Sphinx."""
    app.add_search_language(Questions)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
