"""Arguments checked before packages and tools are installed for them: a command runs up to where its work begins.

The Makefile sets ONLY in the environment. Work begins at the first step, tool, job or file; what is missing until then
(a package, a tool) is no error yet.
"""

import os

ONLY = "TALBOT_CHECK"


class Checked(BaseException):
    """The arguments are right as far as can be said without the work."""


def work_begins() -> None:
    """End a command that only checks its arguments: raises Checked."""
    if os.environ.get(ONLY):
        raise Checked
