"""Files, written beside their place and renamed, as baker/common/files/write_file.cpp does."""
import contextlib
import errno
import fcntl
import json
import os
import re
import secrets
import shutil
import stat

_PART = re.compile(r"\.part-[0-9a-f]{24}$")


def _lock(descriptor):
    fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)


def _is_file_with_a_name(descriptor):
    status = os.fstat(descriptor)
    return stat.S_ISREG(status.st_mode) and status.st_nlink > 0


def remove_left_parts(place):
    """Those that a process left that was killed: nobody has a lock on them. A link is nobody's part."""
    folder, name = os.path.split(place)
    entries = []
    with contextlib.suppress(OSError):  # who cannot read a folder may still write into it
        entries = os.listdir(folder or ".")
    for entry in entries:
        if not (entry.startswith(name) and _PART.fullmatch(entry, len(name))):
            continue
        path = os.path.join(folder, entry)
        with contextlib.suppress(OSError):
            descriptor = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC)
            try:
                if _is_file_with_a_name(descriptor):
                    _lock(descriptor)
                    os.unlink(path)
            finally:
                os.close(descriptor)


def _is_taken_for_left(descriptor):
    """Before it was locked."""
    try:
        _lock(descriptor)
    except OSError as error:
        return error.errno == errno.EWOULDBLOCK
    return not _is_file_with_a_name(descriptor)


def _new_part(place):
    """Locked until it is closed. A new name each time: process ids are the same again in every container."""
    while True:
        path = f"{place}.part-{secrets.token_hex(12)}"
        try:
            descriptor = os.open(path, os.O_RDWR | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW | os.O_CLOEXEC, 0o666)
        except FileExistsError:
            continue
        if not _is_taken_for_left(descriptor):
            return path, descriptor
        os.close(descriptor)


def _flush_to_disk(descriptor):
    """A full disk may show itself only here; some file systems cannot."""
    try:
        os.fsync(descriptor)
    except OSError as error:
        if error.errno not in (errno.EINVAL, errno.ENOTSUP):
            raise


@contextlib.contextmanager
def written(path, mode="w"):
    """A file that is at `path` once all has been written to it, and never half of it: after an error what was there is. Pipes and devices, which
    renaming would replace, are written to."""
    place = os.path.realpath(path) if os.path.islink(path) else os.fspath(path)
    if os.path.exists(place) and not os.path.isfile(place):
        with open(place, mode) as file:
            yield file
        return
    remove_left_parts(place)
    part, descriptor = _new_part(place)
    with os.fdopen(descriptor, mode) as file:
        try:
            yield file
            file.flush()
            _flush_to_disk(file.fileno())
            os.replace(part, place)
        except BaseException:
            with contextlib.suppress(OSError):
                os.unlink(part)
            raise


def write_text(path, text):
    with written(path) as file:
        file.write(text)


def write_json(path, value):
    write_text(path, json.dumps(value, indent=1) + "\n")


def put_copy(source, path):
    with open(source, "rb") as what, written(path, "wb") as file:
        shutil.copyfileobj(what, file)
