"""Physics: sums whose order the compiler may choose, so that a loop that adds up in this way is vectorised."""

from typing import Any

import numba

__all__ = ["add"]


@numba.njit(error_model="numpy", fastmath={"contract", "reassoc", "nsz"})
def add(total: Any, term: Any) -> Any:
    """Return ``total`` + ``term``; of several such additions in a loop the order is free.

    No other operation of a loop may be reordered: what the compiler makes of sums alone does not change when it
    optimises a loop a second time, as it does for the disk cache. Loops that are reordered as a whole had other bits
    in the process that compiled them than in those that load them.
    """
    return total + term
