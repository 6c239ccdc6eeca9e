"""Text from elsewhere, such as titles and paths, made fit to be shown."""

REPLACEMENT = "\ufffd"
"""Replacement of a character that cannot be shown."""


def plain(text: str, kept: str = "\n\t") -> str:
    """The text with every character that cannot be shown replaced, unless it is among ``kept``.

    Control characters would steer a terminal, and lone surrogates, which stand for the bytes of a name that
    is not UTF-8, fit into no output.
    """
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() or c in kept else REPLACEMENT for c in text)


def plain_line(text: str) -> str:
    """The text in one line, with every character that cannot be shown replaced."""
    return plain(" ".join(text.split()) if "\n" in text or "\t" in text else text, kept="")
