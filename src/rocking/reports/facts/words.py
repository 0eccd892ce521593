"""What a restitution is called where people read it: the short names of the models."""

from rocking.restitution import models

_EQUALS = "\N{NO-BREAK SPACE}=\N{NO-BREAK SPACE}"


def restitution_words(label: str) -> str:
    """Return what a restitution is called in a sentence, a table or a picture.

    Returns A model by its short name, a coefficient with its symbol; what is neither, as it is.

    >>> restitution_words("ked"), restitution_words("shifted-impulse:k=0.6").replace(chr(160), " ")
    ('KED', 'shifted impulse, k = 0.6')
    >>> restitution_words("0.9"), restitution_words("left 0.9, right 0.8")
    ('r = 0.9', 'r: left 0.9, right 0.8')
    """
    factor, _, model = label.rpartition("*")
    name, _, parameters = model.partition(":")
    if name in (kinds := models()) and kinds[name].short_name:
        told = [kinds[name].short_name, *(one.strip().replace("=", _EQUALS) for one in parameters.split(",") if one)]
        times = f"{factor}\N{NO-BREAK SPACE}\N{MULTIPLICATION SIGN}\N{NO-BREAK SPACE}" if factor else ""
        return times + ", ".join(told)
    if label.startswith("left "):
        return f"r: {label}"
    return f"r = {label}" if _is_number(label) else label


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
