# SPDX-License-Identifier: GPL-3.0-or-later
"""Copies of cases for tests: a user's results stay as they are."""

import pathlib
import shutil
import tempfile

CASES = pathlib.Path(__file__).resolve().parents[2] / "cases"


def copy_case(test, name):
    """The path of a copy of the case's inputs, beside what cases share, that lives as long as the test."""
    folder = tempfile.TemporaryDirectory()
    test.addCleanup(folder.cleanup)
    root = pathlib.Path(folder.name)
    for shared in (CASES / "RunFunctions", *CASES.glob("*.py")):
        shutil.copy(shared, root)
    results = shutil.ignore_patterns("runs", "study", "doc", "*.png", "postProcessing", "log.*", "polyMesh")
    shutil.copytree(CASES / name, root / name, ignore=results)
    return root / name
