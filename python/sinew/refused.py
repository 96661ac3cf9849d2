"""What the library or a program of its refuses."""


class Refused(ValueError):
    """The line says what, where and how to mend it. `status`: sinew_status, or the program's exit code."""

    def __init__(self, status, message):
        super().__init__(message)
        self.status = status
