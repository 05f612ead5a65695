"""Errors in words for a person."""


class TractusError(Exception):
    """What was wrong. `status` is the HTTP status of the answer and `code` the server's word for the cause, if it answered."""

    def __init__(self, what, status=None, code=None):
        super().__init__(what)
        self.status, self.code = status, code
