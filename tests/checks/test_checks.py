"""The checks of the source tree find what they are for, and nothing in a clean tree."""

import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))
from checks import docs, includes, layers, transforms  # noqa: E402


class Tree(unittest.TestCase):
    def setUp(self):
        self._folder = tempfile.TemporaryDirectory()
        self.addCleanup(self._folder.cleanup)
        self.root = Path(self._folder.name)
        self.write("README.md", "# evo-run\n")

    def write(self, path, text):
        file = self.root / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")


class LayersTest(Tree):
    def setUp(self):
        super().setUp()
        self.write("include/evo/geometry/se3.hpp", "namespace evo::geometry {\nclass SE3 {};\n}\n")
        self.write("src/tracking/a.cpp", '#include "evo/geometry/se3.hpp"\nnamespace evo::tracking {\n}\n')

    def test_a_clean_tree_has_no_problem(self):
        self.assertEqual(layers.check(self.root), [])

    def test_a_lower_layer_must_not_include_a_higher_one(self):
        self.write("include/evo/report/csv.hpp", "namespace evo::report {}\n")
        self.write("src/geometry/se3.cpp", '#include "evo/report/csv.hpp"\nnamespace evo::geometry {\n}\n')
        problem = "src/geometry/se3.cpp:1: geometry must not include report, which is a layer above it"
        self.assertIn(problem, layers.check(self.root))

    def test_a_private_header_of_another_module_is_refused(self):
        self.write("src/events/tiles.hpp", "namespace evo::events {\n}\n")
        self.write("src/tracking/a.cpp", '#include "evo/geometry/se3.hpp"\n#include "events/tiles.hpp"\n')
        problems = layers.check(self.root)
        self.assertEqual(len(problems), 1)
        self.assertIn('src/tracking/a.cpp:2: "events/tiles.hpp" is private to events', problems[0])

    def test_a_public_header_must_not_include_a_private_one(self):
        self.write("src/geometry/hidden.hpp", "namespace evo::geometry {\n}\n")
        self.write("include/evo/geometry/se3.hpp", '#include "geometry/hidden.hpp"\n')
        self.assertTrue(any("must not include the private" in p for p in layers.check(self.root)))

    def test_a_public_header_that_nobody_shares_is_refused(self):
        self.write("include/evo/geometry/alone.hpp", "namespace evo::geometry {\n}\n")
        self.assertEqual(len(layers.check(self.root)), 1)

    def test_names_belong_into_the_namespace_of_their_module(self):
        self.write("src/tracking/b.cpp", "namespace evo::odometry {\n}\n")
        problem = "src/tracking/b.cpp:1: namespace evo::odometry should be evo::tracking"
        self.assertEqual(layers.check(self.root), [problem])


class TransformsTest(Tree):
    def problems(self, line):
        self.write("src/odometry/a.cpp", line + "\n")
        return transforms.check(self.root)

    def test_transforms_are_called_by_their_frames(self):
        self.assertEqual(self.problems("const SE3& T_world_cam, SE3 T_cam_body_end_;"), [])
        self.assertEqual(len(self.problems("const geometry::SE3 pose = start;")), 1)

    def test_functions_and_generic_arguments_may_be_called_otherwise(self):
        self.assertEqual(self.problems("SE3 Interpolate(const SE3& a, const SE3& b, double s);"), [])

    def test_products_join_equal_frames(self):
        self.assertEqual(self.problems("auto T = T_world_cam * T_cam_body; T_world_a.Inverse() * T_world_b;"), [])
        self.assertEqual(len(self.problems("auto T = T_world_cam * T_world_body;")), 1)
        self.assertEqual(len(self.problems("auto T = T_world_cam.Inverse() * T_cam_body;")), 1)

    def test_every_product_of_a_chain_is_looked_at(self):
        self.assertEqual(len(self.problems("T_a_b * T_b_c * T_d_e")), 1)

    def test_comments_do_not_count(self):
        self.assertEqual(self.problems("// SE3 pose = T_a_b * T_c_d"), [])


class IncludesTest(Tree):
    def setUp(self):
        super().setUp()
        self.write("include/evo/core/time.hpp", "using TimeNs = long;\ndouble ToSeconds(TimeNs t);\n")
        self.write("src/io/a.hpp", "struct A {};\n")

    def test_the_own_header_comes_first(self):
        self.write("src/io/a.cpp", '#include "evo/core/time.hpp"\n#include "io/a.hpp"\nTimeNs t;\n')
        self.assertEqual(includes.check(self.root), ['src/io/a.cpp:2: its own header "io/a.hpp" should come first'])

    def test_an_include_of_which_nothing_is_used_is_refused(self):
        self.write("src/io/b.cpp", '#include "evo/core/time.hpp"\nint main() {}\n')
        self.assertEqual(includes.check(self.root), ['src/io/b.cpp:1: nothing of "evo/core/time.hpp" is used'])
        self.write("src/io/b.cpp", '#include "evo/core/time.hpp"\ndouble s = ToSeconds(1);\n')
        self.assertEqual(includes.check(self.root), [])


FAKE = """#!/bin/sh
case "$*" in
  --help) printf 'Subcommands:\\n  run   runs\\n  config   parameters\\n' ;;
  "run --help") echo '--events FILE  --out DIR' ;;
  "config --help") echo '--print --markdown' ;;
  "config --print") printf 'tracker:\\n  features: 150\\n' ;;
  "config --markdown") echo table ;;
esac
"""


class DocsTest(Tree):
    def setUp(self):
        super().setUp()
        self.binary = self.root / "evo-run"
        self.write("evo-run", FAKE)
        self.binary.chmod(0o755)
        self.write("configs/default.yaml", "tracker:\n  features: 150\n")
        self.write("docs/parameters.md", "table\n")

    def problems(self, text):
        self.write("docs/page.md", text)
        return docs.check(self.root, self.binary)

    def test_what_exists_may_be_named(self):
        text = ("# A page\n[here](#a-page) [there](../README.md) `evo-run run --events E --out O` "
                "`tracker.features` `configs/default.yaml`\n")
        self.assertEqual(self.problems(text), [])

    def test_links_resolve(self):
        self.assertEqual(len(self.problems("[a](missing.md) [b](../README.md#none)")), 2)

    def test_commands_options_parameters_and_files_exist(self):
        self.assertEqual(len(self.problems("`evo-run fly`")), 1)
        self.assertEqual(len(self.problems("`evo-run run --hover`")), 1)
        self.assertEqual(len(self.problems("`tracker.wings=2`")), 1)
        self.assertEqual(len(self.problems("`scripts/fly.sh`")), 1)

    def test_generated_files_are_current(self):
        self.write("configs/default.yaml", "tracker:\n  features: 151\n")
        self.assertEqual(len(self.problems("")), 1)

    def test_the_readme_is_short(self):
        self.write("README.md", "line\n" * (docs.README_LINES + 1))
        self.assertEqual(len(self.problems("")), 1)


if __name__ == "__main__":
    unittest.main()
