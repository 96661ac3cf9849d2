# parameter_pictures.py  docs/parameters/make.py: what it cannot draw is refused in one line.
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SCRIPT = Path(__file__).parents[2] / "docs/parameters/make.py"


class ParameterPictures(unittest.TestCase):
    def refused(self, *arguments, words):
        result = subprocess.run([sys.executable, SCRIPT, *arguments], capture_output=True, text=True)
        self.assertEqual(result.returncode, 2)
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        for word in words:
            self.assertIn(word, result.stderr)

    def test_a_folder_without_a_build_is_refused(self):
        self.refused(words=["BUILD"])
        with tempfile.TemporaryDirectory() as folder:
            self.refused(folder, words=["sinew-bake", folder])

    def test_a_picture_that_there_is_not_is_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            for file in ("bin/sinew-bake", "runtime/libsinew.so"):
                (Path(folder) / file).parent.mkdir()
                (Path(folder) / file).touch()
            self.refused(folder, "no_such", words=["no_such", "soft_stiffness"])


if __name__ == "__main__":
    unittest.main()
