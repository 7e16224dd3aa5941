"""Names of the channels of an image file."""

from collections.abc import Sequence


def channel_names(given: Sequence[str], count: int) -> tuple[str, ...]:
    """A name for each channel: those given, each made unique, or "0", "1", … where they are not as many."""
    if len(given) != count:
        return tuple(str(number) for number in range(count))
    again = [given[:place].count(name) for place, name in enumerate(given)]
    return tuple(f"{name} ({n + 1})" if n else name for name, n in zip(given, again, strict=True))
