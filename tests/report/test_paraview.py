#!/usr/bin/env python3
"""The ParaView macro finds the files of a run, and shows each set once: with ParaView's module replaced by one that
writes down what is asked of it.

    test_paraview.py
"""
import sys
import tempfile
import unittest
from pathlib import Path
from unittest.mock import MagicMock

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "share" / "paraview"))
import sphgeo_run as macro  # noqa: E402


class Macro(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.run_folder = Path(self.temporary.name) / "run"
        (self.run_folder / "frames").mkdir(parents=True)
        for name in ("boundaries", "soil", "solids", "water"):
            (self.run_folder / "frames" / f"{name}.pvd").write_text("<VTKFile/>")
        (self.run_folder / "resolved.yaml").write_text("title: x\ndimension: 2\nresolution: 0.02\nnumerics:\n  resolution: 7\n")

    def tearDown(self):
        self.temporary.cleanup()

    def test_finds_the_files(self):
        frames = self.run_folder / "frames"
        wanted = ["soil", "solids", "water", "boundaries"]
        for start in (self.run_folder, frames, frames / "water.pvd"):
            found = macro.collections(start)
            self.assertEqual(list(found), wanted)
            self.assertEqual(found["water"], frames / "water.pvd")
        with self.assertRaises(FileNotFoundError):
            macro.collections(Path(self.temporary.name) / "nothing" / "there")
        self.assertEqual(macro.run_folder(frames / "water.pvd"), self.run_folder)

    def test_reads_the_deck(self):
        self.assertEqual(macro.deck_value(self.run_folder, "resolution"), 0.02)
        self.assertEqual(macro.deck_value(self.run_folder, "dimension"), 2)
        self.assertIsNone(macro.deck_value(self.run_folder, "title"))
        self.assertIsNone(macro.deck_value(self.run_folder / "frames", "resolution"))

    def test_chooses_fields_and_folders(self):
        self.assertEqual(macro.field_of("water", ["id", "pressure"]), "pressure")
        self.assertEqual(macro.field_of("solids_2", ["velocity", "von_mises"]), "von_mises")
        self.assertIsNone(macro.field_of("soil", ["id"]))
        self.assertEqual(macro.where_from(["a"], {"SPHGEO_RUN": "b"}, "c"), Path("a"))
        self.assertEqual(macro.where_from([], {"SPHGEO_RUN": "b"}, "c"), Path("b"))
        self.assertEqual(macro.where_from([], {}, str(self.run_folder / "frames" / "soil.pvd")), self.run_folder)

    def test_shows_each_set(self):
        pv, displays = MagicMock(), {}

        def reader(registrationName, FileName):
            made = MagicMock(FileName=FileName)
            made.PointData.GetNumberOfArrays.return_value = 1
            made.PointData.GetArray.return_value.Name = "velocity"
            return made

        def shown(source, view):
            return displays.setdefault(Path(source.FileName).stem, MagicMock())

        pv.PVDReader.side_effect, pv.Show.side_effect = reader, shown
        readers = macro.show(pv, self.run_folder)
        self.assertEqual(set(readers), {"water", "soil", "solids", "boundaries"})
        self.assertEqual(set(displays), set(readers))
        displays["water"].SetRepresentationType.assert_called_once_with("Point Gaussian")
        self.assertEqual(displays["water"].GaussianRadius, 0.01)
        displays["boundaries"].SetRepresentationType.assert_called_once_with("Surface")
        pv.ColorBy.assert_any_call(displays["water"], ("POINTS", "velocity", "Magnitude"))
        pv.ColorBy.assert_any_call(displays["boundaries"], None)


if __name__ == "__main__":
    unittest.main(verbosity=0)
