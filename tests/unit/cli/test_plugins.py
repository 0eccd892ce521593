"""Commands of other distributions, by the entry-point group `rocking.commands`."""

import sys

MODULE = '''
def weigh(times: int = 2) -> None:
    """Weigh a body."""
    print(f"weighed {times} times")
'''


def install(folder):
    """Write the files of an installed distribution with the command `weigh`."""
    metadata = folder / "scales-1.0.dist-info"
    metadata.mkdir()
    (metadata / "entry_points.txt").write_text(
        "[console_scripts]\nscales = scales:weigh\n\n"
        "[rocking.commands]\nweigh = scales:weigh\nsimulate = scales:weigh\n",
        "utf-8",
    )
    (folder / "scales.py").write_text(MODULE, "utf-8")


def test_a_distribution_adds_a_command(run, tmp_path, monkeypatch):
    """The command is listed, has help and options, and runs; it does not replace a command of the library."""
    install(tmp_path)
    assert run("weigh")[0] == 2
    monkeypatch.syspath_prepend(tmp_path)
    assert "Weigh a body." in run("--help")[1]
    assert run("weigh", "--times", "3") == (0, "weighed 3 times\n", "")
    assert "Weigh a body." in run("weigh", "--help")[1]
    assert "weigh" not in run("simulate", "--help")[1].casefold().split()


def test_without_its_distribution_a_known_command_names_it(refuses, monkeypatch, tmp_path):
    monkeypatch.setattr(sys, "path", [str(tmp_path)])
    refuses(("serve", "--no-browser"), "rocking serve needs rocking-workbench: pip install rocking-workbench")
