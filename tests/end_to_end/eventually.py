"""Waiting that ends."""

import time


def eventually(seconds, look, is_there):
    """What `look` sees as soon as `is_there` says yes to it; fails with the last that it saw."""
    end = time.monotonic() + seconds
    while not is_there(seen := look()):
        assert time.monotonic() < end, f"waited {seconds} s in vain, and there is still {str(seen)[:400]}"
        time.sleep(0.02)
    return seen
