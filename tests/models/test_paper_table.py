"""docs/paper.md: every row of its table from the paper to the code names files and tests that exist."""
import os
import re
import unittest
from pathlib import Path

REPOSITORY = Path(os.path.dirname(os.path.abspath(__file__))).parents[1]


def rows():
    """(paper, code, test) of the table "Where each part is"."""
    text = (REPOSITORY / "docs/paper.md").read_text().split("## Where each part is")[1].split("\n## ")[0]
    lines = [line for line in text.splitlines() if line.startswith("|")]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[2:]]


class PaperTable(unittest.TestCase):
    def test_every_row_has_code_and_a_test(self):
        sources = {p.name: p.read_text() for p in (REPOSITORY / "tests").rglob("*test*") if p.suffix in (".cpp", ".py")}
        self.assertGreater(len(rows()), 25)
        for row in rows():
            with self.subTest(row[0]):
                self.assertEqual(len(row), 3)
                _, code, test = row
                for path in re.findall(r"`(core/[^`]+)`", code):
                    self.assertTrue((REPOSITORY / path).exists(), path)
                for name in re.findall(r"`(\w+)\(\)`", code):
                    declared = any(f"{name}(" in p.read_text() for p in (REPOSITORY / "core").rglob("*.h"))
                    self.assertTrue(declared, name)
                files = re.findall(r"`(?:[\w/]+/)?(\w+\.(?:cpp|py))`", test)
                self.assertTrue(files, "no test")
                for file in files:
                    self.assertIn(file, sources)
                for name in re.findall(r"`([A-Z]\w+)(?:\.\.\.)?`", test):
                    self.assertTrue(any(name in sources[file] for file in files), name)


if __name__ == "__main__":
    unittest.main()
