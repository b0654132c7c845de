"""Compiled: what a failed compilation means, in one sentence, with the place in the author's code and a remedy."""

import re
import traceback
from pathlib import Path

import numba

_OWN = str(Path(__file__).parents[1])
_ADVICE = {
    r"Untyped global name '(\w+)'.*'function'": "decorate {0} with numba.njit, or define it inside the method",
    r"Untyped global name '(\w+)'": "{0} cannot be compiled: use numbers, tuples and jitted functions",
    r"NameError: name '(\w+)'": "define or import {0}",
    r"Cannot unify .*? for '(\w+)": "{0} must have the same type on every branch, and every branch must return",
    r"No implementation of function": "compiled code knows a part of NumPy only: write it as a loop over numbers",
    r"Unknown attribute|Cannot bind|missing a required argument|too many positional": "check the spelling and the call",
    r"ast (Optional|none|None)|got None": "every branch must return a value: a 'return' is missing",
}


def explained(error: BaseException) -> str | None:
    """Return why the compilation that raised ``error`` failed, and where; None for an error of another origin."""
    frames = [str(frame.f_globals.get("__name__", "")) for frame, _ in traceback.walk_tb(error.__traceback__)]
    if not isinstance(error, numba.core.errors.NumbaError) and not any(f.startswith("numba.") for f in frames):
        return None
    text = str(error)
    lines = [line.strip() for line in text.splitlines() if line.strip() and not line.startswith("Failed in")]
    reason = lines[0] if lines else type(error).__name__
    inner = re.search(r"^\s+(?:TypingError|ValueError|InputError): (.+)$", text, re.MULTILINE)
    signature = re.search(r"^\s*>>> (.+)$", text, re.MULTILINE)
    if inner:
        reason = inner[1]
    elif signature:
        reason = f"there is no {signature[1]}"
    if not isinstance(error, numba.core.errors.NumbaError):
        reason = f"{type(error).__name__}: {reason}"
    places = re.findall(r'File "([^"]+)", line (\d+)', text)
    own = [(file, line) for file, line in places if "sphframe/" not in file and not Path(file).is_relative_to(_OWN)]
    where = " ({}, line {})".format(*own[0]) if own else ""
    advice = ""
    for pattern, remedy in _ADVICE.items() if not inner else ():
        match = re.search(pattern, text, re.DOTALL if "Untyped" not in pattern else 0)
        if match:
            advice = f"; {remedy.format(*match.groups())}"
            break
    return f"does not compile: {reason.rstrip(':. ')}{where}{advice}"
