"""What a run replaces of an earlier one."""

from talbot.pixels.test_chip.job import FILES, TEXTS


def test_a_second_run_into_the_same_folder_replaces_files_by_name_and_folders_whole():
    """A path in a folder was looked for in the folder that the run had just replaced: the second run failed."""
    assert "docs/info.md" in TEXTS
    assert all("/" not in name for name in FILES)
