"""What is kept last, within a bound of bytes."""

from cytodisk.napari.study_layers.byte_cache import ByteCache


def test_what_was_used_last_is_kept_within_the_bound() -> None:
    cache: ByteCache[bytes] = ByteCache(10, len)
    for key in "abc":
        cache.get(key, lambda: b"1234")
    cache.get("b", lambda: b"other")

    assert "a" not in cache
    assert cache.get("b", lambda: b"other") == b"1234"
    assert cache.n_bytes == 8

    cache.get("d", lambda: b"5678")
    assert "c" not in cache
    assert "b" in cache


def test_what_is_larger_than_the_bound_is_given_but_not_kept() -> None:
    cache: ByteCache[bytes] = ByteCache(3, len)

    assert cache.get("a", lambda: b"1234") == b"1234"
    assert (len(cache), cache.n_bytes) == (0, 0)
