"""The errors ribbonopt raises, one class for each kind of fault.

`SceneError` and `ModelError` mean that the input must change (exit status 2 on the command
line); `ConvergenceError` means that the mathematics resisted (exit status 3).
"""


class RibbonoptError(Exception):
    """Base of every error raised on purpose by ribbonopt."""


class SceneError(RibbonoptError, ValueError):
    """A scene file or override that cannot be read: names the file, line, key and remedy."""


class ModelError(RibbonoptError, ValueError):
    """A readable scene whose mechanics does not hold together (counts, ranks, frames).

    `key` is the dotted path of the scene that is to blame, for those who know its file.
    """

    def __init__(self, message: str, key: str = "") -> None:
        super().__init__(message)
        self.key = key


class TranscriptionError(RibbonoptError, ValueError):
    """A discretisation that cannot be formed, such as a scheme of degree 0."""


class OutputError(RibbonoptError, OSError):
    """A place where results cannot be written or from which they cannot be read."""


class WorkerError(RibbonoptError, RuntimeError):
    """A worker process that cannot be started: says what it said, or why there is none."""


class PictureError(OutputError):
    """Pictures that could not be drawn or written: says which and why; all else is there."""


class ViewError(RibbonoptError, ValueError):
    """A picture that there is none of, such as the surface of a rod: says why."""


class PackageError(RibbonoptError, ImportError):
    """A package that is needed for one thing alone and is not installed: says which, and how."""


class ConvergenceError(RibbonoptError, RuntimeError):
    """No equilibrium can be, or was, found: says which condition resists and the remedy.

    `status` is the name of the failure, as summaries give it.
    """

    def __init__(self, message: str, status: str) -> None:
        super().__init__(message)
        self.status = status


def no_memory(error: BaseException) -> bool:
    """Whether an error says that there is no memory left, in the words of Python or of CasADi."""
    return isinstance(error, MemoryError) or "std::bad_alloc" in str(error)
