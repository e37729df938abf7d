#!/usr/bin/env python3
"""Does docs_links.py find what is wrong? Pages are planted with links of each kind."""
import os
import subprocess
import sys
import tempfile
import unittest

import docs_links

GOOD = """# Of walls

[`wall.h`](code/wall.h), [`code/wall.h`](code/wall.h), [`wall`](code/wall.h), [the folder](code), [below](#of-walls-1),
[elsewhere](docs/other.md#a-b--c_d-1), [over two
lines](docs/other.md), [the web](https://example.org/gone.h), ![a picture](code/wall.h "its title")
`[no](link.md)` and ``[none ` either](link.md)``, [`array[3]`](code/wall.h)

```
[in code](nowhere.h)
```

## Of walls

See [that][1].

[1]: docs/other.md
"""
OTHER = """## A `b` & C_d

## A b & C_d!

[back](../README.md)
"""


class DocsLinks(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.write("code/wall.h", "")
        self.write("docs/other.md", OTHER)
        self.write("build/page.md", "[made](gone.h)")
        self.write("README.md", GOOD)

    def write(self, path, text):
        path = os.path.join(self.folder.name, path)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)

    def faults(self):
        return docs_links.faults(self.folder.name)[1]

    def test_right_links_are_right(self):
        self.assertEqual(docs_links.faults(self.folder.name), (11, []))

    def test_each_wrong_link_is_told_with_its_line(self):
        self.write("docs/wrong.md", """[`roof.h`](../code/wall.h)
[`all.h`](../code/wall.h) [`src/wall.h`](../code/wall.h)

[a](../code/roof.h)
[b](../code/Wall.h) [c](code/wall.h)
[d](other.md#a) [e](#f)
[g](../../wall.h)
[h]: gone.md
""")
        self.assertEqual(self.faults(), [
            "docs/wrong.md:1: [`roof.h`](../code/wall.h): its text is the name of another file",
            "docs/wrong.md:2: [`all.h`](../code/wall.h): its text is the name of another file",
            "docs/wrong.md:2: [`src/wall.h`](../code/wall.h): its text is the name of another file",
            "docs/wrong.md:4: [a](../code/roof.h): leads nowhere",
            "docs/wrong.md:5: [b](../code/Wall.h): leads nowhere",
            "docs/wrong.md:5: [c](code/wall.h): leads nowhere",
            "docs/wrong.md:6: [d](other.md#a): docs/other.md has no heading for #a",
            "docs/wrong.md:6: [e](#f): docs/wrong.md has no heading for #f",
            "docs/wrong.md:7: [g](../../wall.h): leads out of the repository",
            "docs/wrong.md:8: [h](gone.md): leads nowhere"])

    def test_a_wrong_link_fails_the_script_and_so_does_a_tree_without_links(self):
        def code():
            return subprocess.run([sys.executable, docs_links.__file__, self.folder.name],
                                  stdout=subprocess.DEVNULL, check=False).returncode
        self.assertEqual(code(), 0)
        self.write("docs/wrong.md", "[a](gone.h)")
        self.assertEqual(code(), 1)
        for page in ("README.md", "docs/other.md", "docs/wrong.md"):
            self.write(page, "")
        self.assertEqual(code(), 1)


if __name__ == "__main__":
    unittest.main()
