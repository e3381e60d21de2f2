"""Libraries that crash, hang or eat the memory, called in a process of their own."""

from stackloft_plugins.worker.limits import Limits
from stackloft_plugins.worker.run import WorkerError, run_alone

__all__ = ["Limits", "WorkerError", "run_alone"]
