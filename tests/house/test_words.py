"""Tests words.py on made-up files, and its list of words on sentences that must fail and that must pass."""
import contextlib
import io
import pathlib
import tempfile
import unittest

import words

CAUGHT = {
    "place": ["read from its place", "at the same place", "give a finite place", "read_points: place %zu: a weight", "%zu places, but room for %zu"],
    "share": ["a share of the budget", "times as shares of it", "of height, share left 0.1"],
    "how_far": ["How far a vertex moves"],
    "way": ["Green is the way of a pose"],
    "hear": ["the first mode that heard it"],
    "listen": ["the modes that listen to a force"],
    "feel": ["the gravity that it feels", "a felt acceleration"],
    "phi": ["the gravity and phi of the frame"],
    "tell": ["the report tells the time", "a node is told its position"],
    "who": ["who is asleep, who waits", "who is out of view costs nothing", "the plan says who gets which"],
    "nobody": ["nobody sees it"],
    "sleeper": ["sleepers wake"],
    "tail": ["after its tail has faded", "the tail of its displacement"],
    "ride": ["the offset rides the pose"],
    "seam": ["the seam of a change of LOD", "its seam fades"],
    "law": ["both laws are blended"],
    "carry": ["also every carried vertex", "the carry weights", "its carrying weights", "the nodes carry vertices", "a region carries other vertices"],
    "level": ["in the finer level", "level %u: a section ends early", "a level of control graphs", "a node of level 2"],
    "every_tick": ["simulated every second tick"],
    "regain": ["regained regions"],
    "look": ["three blind looks", "one look a frame"],
    "sight": ["out of sight"],
    "drawer": ["sorted into drawers"],
    "turn_of_queue": ["whose turn it is"],
    "turn_of_tissue": ["rod %zu: turn limit %g", "displacement, turn and bend"],
    "fold": ["folds the reports"],
    "plan": ["a plan row"],
    "answer": ["its matrices answer by more", "the modal answer"],
    "kept": ["states kept as halves"],
    "stays": ["it stays as it was", "all stay.", "not finite; the last one stays"],
    "stands": ["the proof stands in the header", "stands at its limit"],
    "own_body": ["contacts with its own body"],
    "proxies": ["thinner proxies"],
    "push": ["vertices are pushed out"],
    "contact_name": ["the name of a hit"],
    "anew": ["bake it anew"],
    "begin_at_rest": ["they begin at rest"],
    "hand_out": ["tiers are handed out"],
    "buy": ["tiers are bought"],
    "continued": ["corrects a rod's continued start"],
    "dear": ["the dearer tier"],
    "flesh": ["flesh swings"],
    "trade": ["the trade of time for error"],
    "beside": ["beside the implicit solver"],
    "likewise": ["rods likewise"],
    "that_which": ["that which moves"],
}
# Ordinary sentences: none of them may be caught by any word of the list.
PASSING = {
    "place": ["joints in the place of those", "placed and replaced", "in the same place"],
    "share": ["two regions share a vertex, and the threads share the step"],
    "how_far": ["how often it runs, and farther away"],
    "way": ["all the way to the floor"],
    "hear": ["the tissue about the heart is sheared"],
    "listen": ["a server that listens on port 8080"],
    "feel": ["a felt hat", "a ball of felt", "set_felt_root_motion"],
    "phi": ["the angle phi", "the angles theta and phi"],
    "tell": ["the bones are told apart"],
    "who": ["who reads this page", "for people who are not programmers", "an artist who gets a pack"],
    "nobody": ["no body of the scene collides"],
    "sleeper": ["a sleeping instance sleeps for a second"],
    "tail": ["the fox's tail swings, and a snap turn of 45 degrees turns it"],
    "ride": ["a character that rides on a cart overrides its stride"],
    "seam": ["no seam between meshes"],
    "law": ["by Hooke's law"],
    "carry": ["a file that carries metadata", "a mesh that carries vertex colours", "carries the vertex colours"],
    "level": ["levels of detail (MSFT_lod)", "the x86 level-1 cache", "compression level 3", "log level 1", "log level %d", "one level up"],
    "every_tick": ["every tick of every second frame"],
    "regain": ["the gain rises again"],
    "look": ["look at the picture"],
    "sight": ["in the line of sight"],
    "drawer": ["drawn pictures and draws"],
    "turn_of_queue": ["the queue returns the oldest in turn"],
    "turn_of_tissue": ["the character turns to the left"],
    "fold": ["folded into the weights"],
    "plan": ["a plan of bodies and motions"],
    "answer": ["answers a question"],
    "kept": ["kept apart"],
    "stays": ["stays rigid", "Not all stay rigid"],
    "stands": ["the character stands still"],
    "own_body": ["its own skeleton and body"],
    "proxies": ["the recipe's \"proxies\"", "an HTTP proxy", "a proxy server"],
    "push": ["a ball to push with", "press a key; the button is pressed"],
    "contact_name": ["the name of a file"],
    "anew": ["a new pack"],
    "begin_at_rest": ["begins with the rest pose"],
    "hand_out": ["the hand reaches out"],
    "buy": ["a buyer of the game"],
    "continued": ["RodSettings::start is \"continued\"", "the work continued"],
    "dear": ["a dearth of data"],
    "flesh": ["path/share/flesh.png"],
    "trade": ["the accuracy-cost trade-off of sinew-trade"],
    "beside": ["--beside", "besides these"],
    "likewise": ["like all others, clockwise"],
    "that_which": ["that file, which is short"],
}


class Words(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name, "project")
        self.house = pathlib.Path(folder.name, "house")
        self.house.mkdir()
        self.write("good.md", "Soft tissue swings.\n")
        self.write("words.csv", "id,pattern,instead,note\nflesh,flesh,soft tissue,\nanew,anew,again,\n", self.house)

    def write(self, name, text, root=None):
        path = (root or self.root) / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def run_words(self):
        out = io.StringIO()
        with contextlib.redirect_stdout(out):
            code = words.main(self.root, self.house)
        return code, out.getvalue()

    def lines(self, name, text):
        """The lines in which a file of this name and text has the word flesh."""
        self.write(name, text)
        code, out = self.run_words()
        (self.root / name).unlink()
        found = [int(line.split(":")[1]) for line in out.splitlines() if line.startswith(name)]
        self.assertEqual(code, 1 if found else 0)
        return found

    def test_a_word_fails_with_its_file_line_and_substitute(self):
        self.write("README.md", "# Page\n\nAll is\nwell: Flesh swings.\n")
        code, out = self.run_words()
        self.assertEqual(code, 1)
        self.assertIn('README.md:4: "Flesh" -> use "soft tissue"', out)

    def test_no_word_passes(self):
        self.assertEqual(self.run_words()[0], 0)

    def test_code_and_links_of_pages_pass(self):
        self.assertEqual(self.lines("a.md", "Text.\n\n```cpp\nflesh();\n```\nflesh\n"), [6])
        self.assertEqual(self.lines("a.md", "## Head\n    run flesh    # flesh\n\n    flesh\n\nflesh\n"), [6])
        self.assertEqual(self.lines("a.md", "`flesh` and\n``flesh ` flesh`` in [a page](flesh.md), see https://a.b/flesh\n"), [])
        self.assertEqual(self.lines("a.md", "- an item\n  goes on\n\n    with flesh\n"), [4])

    def test_generated_reports_and_build_folders_are_no_pages(self):
        for name in ("report.txt", "build/a.md", "out/a.md", ".hidden/a.md"):
            self.assertEqual(self.lines(name, "flesh\n"), [])

    def test_strings_of_c_count_and_comments_do_not(self):
        self.assertEqual(self.lines("runtime/a.cpp", '// flesh here\n/* more\nflesh */ f("flesh swings");  // flesh\n'), [3])
        self.assertEqual(self.lines("baker/a.hpp", 'f("soft "\n  "parts of\\n"  // flesh\n  "flesh");\n'), [3])
        self.assertEqual(self.lines("perf/a.c", "char c = '\"'; int n = 1'000; f(\"the\\nflesh\\\"\", '\\'');\n"), [1])
        self.assertEqual(self.lines("samples/a.cpp", 'f(R"(a\n"flesh" of\nflesh)");\n'), [3])

    def test_names_paths_and_includes_of_c_pass(self):
        self.assertEqual(self.lines("runtime/a.cpp", '#include "a flesh.hpp"\nf("flesh"); f("a flesh_m", "--flesh N", "see a/flesh.cpp", "the \\"flesh\\" key");\n'), [])
        self.assertEqual(self.lines("tests/a.cpp", 'f("flesh swings");\n'), [])

    def test_strings_of_python_count_and_comments_do_not(self):
        self.assertEqual(self.lines("perf/a.py", '# flesh\nx = 1  # flesh\nprint(f"of flesh {x}",\n      "a "\n      "flesh")\n'), [3, 5])
        self.assertEqual(self.lines("docs/pictures/a.py", 'title = "all flesh"\n'), [1])
        self.assertEqual(self.lines("python/a.py", '"""About flesh."""\ndef f():\n    """Of flesh."""\n'), [])
        self.assertEqual(self.lines("perf/a.py", '"""About flesh.\n\nusage: a.py FLESH of flesh\n"""\n'), [1, 3, 3])

    def test_strings_of_javascript_and_text_of_html_count(self):
        self.assertEqual(self.lines("samples/a.js", "// flesh, it's\nf('all flesh', /\"/, `of ${flesh} and\nflesh`);  // 'of flesh'\n"), [2, 3])
        self.assertEqual(self.lines("samples/a.html", '<p class="of flesh"\n title="of flesh">x</p>\n<b>flesh</b><!-- flesh -->\n<script>\n// flesh\nf("of flesh")\n</script>\n'), [1, 3, 6])

    def test_echo_lines_of_shell_count(self):
        self.assertEqual(self.lines("a.sh", 'flesh=1  # flesh\n[ -n "$flesh" ] || { echo "no flesh: $flesh" >&2; }\n'), [2])

    def test_messages_that_functions_of_shell_get_count(self):
        self.assertEqual(self.lines("a.sh", 'refuse() {\n  echo "$1"\n}\n[ $# = 1 ] || refuse "no flesh: $flesh"\nrefuse "flesh"\nother "no flesh"\n'), [4])
        self.assertEqual(self.lines("a.sh", 'refuse() { echo "no $1"; }\nrefuse "no flesh" || echo of flesh\n'), [2, 2])

    def test_a_folder_with_nothing_to_check_fails(self):
        (self.root / "good.md").unlink()
        for root in (self.root, self.root / "none"):
            with contextlib.redirect_stdout(io.StringIO()) as out:
                self.assertEqual(words.main(root, self.house), 1)
            self.assertIn("no page", out.getvalue())

    def test_every_word_of_the_list_is_caught_and_plain_english_passes(self):
        listed = words.read_words(words.HERE / "words.csv")
        names = [name for name, _, _ in listed]
        self.assertEqual(len(set(names)), len(names))
        self.assertEqual({name for name, texts in CAUGHT.items() if texts}, set(names))
        self.assertEqual({name for name, texts in PASSING.items() if texts}, set(names))
        passing = [text for texts in PASSING.values() for text in texts]
        for name, pattern, _ in listed:
            for text in CAUGHT[name]:
                self.assertTrue(pattern.search(text), f"{name} misses: {text}")
            for text in passing:
                self.assertFalse(pattern.search(text), f"{name} catches: {text}")


if __name__ == "__main__":
    unittest.main()
