"""What a command says on standard error."""


def without_notes(text):
    """All but the notes on the scene: what is empty where nothing went wrong."""
    return "\n".join(line for line in text.splitlines() if not line.startswith("mcgw: note: "))
