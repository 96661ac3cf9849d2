"""Files are whole or as they were, whoever else writes them, and whatever a killed process left beside them."""
import fcntl
import os
import signal
import sys
import tempfile
import time
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "baker"))
from train.files.write_file import put_copy, remove_left_parts, write_json, write_text, written  # noqa: E402

LEFT = ".part-0123456789abcdef01234567"


def read(path):
    with open(path) as file:
        return file.read()


class Files(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = os.path.join(self.folder.name, "pack")

    def entries(self):
        return sorted(os.listdir(self.folder.name))

    def leave(self, end, text="half"):
        with open(self.path + end, "w") as file:
            file.write(text)
        return self.path + end

    def test_what_was_left_is_removed_and_neither_links_nor_what_is_locked_nor_other_names(self):
        other, precious = self.leave(".part-123"), os.path.join(self.folder.name, "precious")
        write_text(precious, "precious")
        link = self.path + ".part-" + "a" * 24
        os.symlink(precious, link)
        os.symlink(precious, self.path + ".part")  # where parts were once written
        left = self.leave(LEFT)
        with open(left) as held:
            fcntl.flock(held, fcntl.LOCK_EX)
            write_json(self.path, {"a": 1})
            self.assertTrue(os.path.exists(left))
        write_text(self.path, "whole")
        self.assertFalse(os.path.exists(left))
        self.assertEqual([read(self.path), read(precious), read(other)], ["whole", "precious", "half"])
        self.assertTrue(os.path.islink(link))

    def test_an_error_leaves_the_old_file_and_nothing_beside_it(self):
        write_text(self.path, "old")
        with self.assertRaises(ValueError):
            with written(self.path) as file:
                file.write("half")
                raise ValueError()
        self.assertEqual(read(self.path), "old")
        self.assertEqual(self.entries(), ["pack"])

    def test_a_pipe_is_written_to_and_stays_one(self):
        os.mkfifo(self.path)
        reader = os.open(self.path, os.O_RDONLY | os.O_NONBLOCK)
        write_text(self.path, "whole")
        self.assertEqual(os.read(reader, 100), b"whole")
        os.close(reader)
        self.assertFalse(os.path.isfile(self.path))
        self.assertEqual(self.entries(), ["pack"])

    def test_a_link_stays_a_link_and_a_copy_is_whole(self):
        link = os.path.join(self.folder.name, "link")
        write_text(self.path, "old")
        os.symlink(self.path, link)
        source = os.path.join(self.folder.name, "source")
        write_text(source, "new")
        put_copy(source, link)
        self.assertTrue(os.path.islink(link))
        self.assertEqual(read(self.path), "new")

    def test_several_at_once_leave_one_whole_file_and_killed_ones_hinder_nobody(self):
        writers = []
        for letter in "abc":
            writer = os.fork()
            if writer == 0:
                while True:
                    write_text(self.path, letter * 100000)
            writers.append(writer)
        end_s = time.monotonic() + 1
        while time.monotonic() < end_s:
            if os.path.exists(self.path):
                text = read(self.path)
                self.assertEqual(text, text[:1] * 100000)
        for writer in writers:
            os.kill(writer, signal.SIGKILL)
            os.waitpid(writer, 0)
        remove_left_parts(self.path)
        self.assertEqual(self.entries(), ["pack"])
        write_text(self.path, "whole")
        self.assertEqual(read(self.path), "whole")


if __name__ == "__main__":
    unittest.main()
