"""A Windows job: a process and all that it starts, which end when the launcher's handle closes.

Windows closes the handles of a program that is killed, so nothing outlives it, whatever it does.
Not run yet on Windows; written after the documentation of Job Objects.
"""

from __future__ import annotations

import ctypes
import sys
from ctypes import wintypes
from typing import Any

EXTENDED_LIMIT_INFORMATION = 9
KILL_ON_JOB_CLOSE = 0x2000


class BasicLimits(ctypes.Structure):
    """JOBOBJECT_BASIC_LIMIT_INFORMATION."""

    _fields_ = (
        ("PerProcessUserTimeLimit", ctypes.c_int64),
        ("PerJobUserTimeLimit", ctypes.c_int64),
        ("LimitFlags", ctypes.c_uint32),
        ("MinimumWorkingSetSize", ctypes.c_size_t),
        ("MaximumWorkingSetSize", ctypes.c_size_t),
        ("ActiveProcessLimit", ctypes.c_uint32),
        ("Affinity", ctypes.c_size_t),
        ("PriorityClass", ctypes.c_uint32),
        ("SchedulingClass", ctypes.c_uint32),
    )


class ExtendedLimits(ctypes.Structure):
    """JOBOBJECT_EXTENDED_LIMIT_INFORMATION."""

    _fields_ = (
        ("BasicLimitInformation", BasicLimits),
        ("IoInfo", ctypes.c_uint64 * 6),
        ("ProcessMemoryLimit", ctypes.c_size_t),
        ("JobMemoryLimit", ctypes.c_size_t),
        ("PeakProcessMemoryUsed", ctypes.c_size_t),
        ("PeakJobMemoryUsed", ctypes.c_size_t),
    )


class Job:
    """Holds one process, by its handle, and all that it starts; raises OSError."""

    def __init__(self, process: int, system: Any = None) -> None:
        self._system = system or _windows()
        self._job = self._system.CreateJobObjectW(None, None)
        try:
            self._succeeded(self._job)
            limits = ExtendedLimits()
            limits.BasicLimitInformation.LimitFlags = KILL_ON_JOB_CLOSE
            kind, size = EXTENDED_LIMIT_INFORMATION, ctypes.sizeof(limits)
            self._succeeded(
                self._system.SetInformationJobObject(self._job, kind, ctypes.byref(limits), size)
            )
            self._succeeded(self._system.AssignProcessToJobObject(self._job, process))
        except OSError:
            self.end()
            raise

    def end(self) -> None:
        """End all that is still in it, and give it up; may be called again."""
        job, self._job = self._job, None
        if job:
            self._system.CloseHandle(job)

    def _succeeded(self, answer: object) -> None:
        if not answer:
            code = int(self._system.GetLastError())
            raise OSError(code, f"Windows error {code}")


def _windows() -> Any:
    """The functions of kernel32, with the types of what they take: a handle is a pointer."""
    if sys.platform != "win32":
        raise OSError("Jobs are there on Windows only.")
    system = ctypes.WinDLL("kernel32")
    handle, flag = wintypes.HANDLE, wintypes.BOOL
    system.CreateJobObjectW.argtypes = (ctypes.c_void_p, wintypes.LPCWSTR)
    system.CreateJobObjectW.restype = handle
    system.SetInformationJobObject.argtypes = (
        handle,
        ctypes.c_int,
        ctypes.c_void_p,
        wintypes.DWORD,
    )
    system.SetInformationJobObject.restype = flag
    system.AssignProcessToJobObject.argtypes = (handle, handle)
    system.AssignProcessToJobObject.restype = flag
    system.CloseHandle.argtypes, system.CloseHandle.restype = (handle,), flag
    return system
