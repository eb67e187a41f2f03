"""Errors of runs and of their files, each with its exit code."""

import errno


class StoreError(ValueError):
    """A file that cannot be read or written, is not an ensemble, or asks for another place.

    Examples
    --------
    >>> import mcgw
    >>> mcgw.open_ensemble("absent.h5")
    Traceback (most recent call last):
    mcgw.errors.StoreError: absent.h5: No such file or directory
    """


class RunError(RuntimeError):
    """A run that could not be finished; what is done is kept.

    Parameters
    ----------
    message : str
        One line: what happened and what to do.
    code : int, optional
        Exit code of the command line.

    Examples
    --------
    >>> import mcgw
    >>> try:
    ...     raise mcgw.RunError("demo.h5: 3 of 10 surfaces are missing; run the jobs that make them again")
    ... except mcgw.RunError as error:
    ...     error.code
    1
    """

    def __init__(self, message: str, code: int = 1) -> None:
        super().__init__(message)
        self.code = code


class StoppedError(RunError):
    """A run that was asked to stop: by Ctrl-C (130) or SIGTERM (143)."""


def extra(name: str) -> str:
    """Return how to install an extra of this package, which no registry has."""
    return f"in a clone of mcgw, pip install -e '.[{name}]'"


def in_one_line(error: OSError, file: object = None) -> str:
    """Return a line of what the system said and of which file; `file` is the one that was being made.

    Of a file that nobody names, on a full disk, Numba's own of the compiled loops is likely.
    """
    name = error.filename or file
    said = error.strerror or str(error)
    if name is None and error.errno in (errno.ENOSPC, errno.EDQUOT):
        name = "compiled loops (NUMBA_CACHE_DIR), or another file"
    return said if name is None else f"{name}: {said}"
