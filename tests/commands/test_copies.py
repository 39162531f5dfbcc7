"""Copies of the notebooks: complete, renewed while nobody touched them, and never lost."""

import json
import os
import re

import nbformat
import pytest

import railbridge as rb
from railbridge.commands import command as cli
from railbridge.commands import copies as lessons

NOTEBOOK = "03_rigid_deck_forces.ipynb"


def command(capsys, *arguments):
    """Exit code, lines on stdout, lines on stderr."""
    code = cli.main(["copy-notebooks", *map(str, arguments)])
    shown = capsys.readouterr()
    return code, shown.out.splitlines(), shown.err.splitlines()


def files(folder):
    return {
        p.relative_to(folder).as_posix(): p.read_bytes()
        for p in sorted(folder.rglob("*"))
        if p.is_file()
    }


@pytest.fixture
def folder(tmp_path, capsys):
    """A folder with fresh copies."""
    assert command(capsys, tmp_path / "mine")[0] == 0
    return tmp_path / "mine"


@pytest.fixture
def newer(monkeypatch):
    """The suite's next edition: one word of one notebook has changed."""
    now = lessons.contents()
    now[NOTEBOOK] = now[NOTEBOOK].replace(b"How hard", b"How very hard")
    monkeypatch.setattr(lessons, "contents", lambda edition="reader": now)
    return now


def test_everything_is_copied_and_nothing_else(folder):
    copies = files(folder)
    assert set(json.loads(copies.pop(lessons.MANIFEST))) == set(copies)
    assert copies == lessons.contents()
    names = {path.name for path in (lessons.suite_root() / "notebooks").glob("[0-9][0-9]_*.ipynb")}
    assert {name for name in copies if name.endswith(".ipynb")} == names


def test_cells_and_outputs_are_those_of_the_suite(folder):
    """Only links may differ, and only in text cells."""
    for path in folder.glob("*.ipynb"):
        ours, copy = (
            nbformat.read(p, as_version=4)
            for p in (lessons.suite_root() / "notebooks" / path.name, path)
        )
        nbformat.validate(copy)
        plain = [re.sub(r"\]\([^()\s]*\)|[][]", "", cell.source) for cell in copy.cells]
        assert plain == [re.sub(r"\]\([^()\s]*\)|[][]", "", cell.source) for cell in ours.cells]
        for cell in (
            cell for nb in (ours, copy) for cell in nb.cells if cell.cell_type == "markdown"
        ):
            cell.source = ""
        assert ours == copy


def test_every_link_of_a_copy_leads_to_a_copy(folder):
    for path in [*folder.rglob("*.ipynb"), *folder.rglob("*.md")]:
        texts = [path.read_text(encoding="utf-8")]
        if path.suffix == ".ipynb":
            texts = [
                cell.source
                for cell in nbformat.read(path, as_version=4).cells
                if cell.cell_type == "markdown"
            ]
        for target in re.findall(r"\]\((?!\w+:)([^()#\s]+)", "\n".join(texts)):
            assert (path.parent / target).is_file(), (path.name, target)


def test_links_between_copies_are_kept(folder):
    start = (folder / "00_start_here.ipynb").read_text(encoding="utf-8")
    assert "](01_vehicle_modes.ipynb)" in start and "](data/vehicles/xia2000.csv)" in start
    assert "](README.md#your-own-vehicle-and-bridge)" in start
    readme = (folder / "README.md").read_text(encoding="utf-8")
    assert "](00_start_here.ipynb)" in readme and "CONTRIBUTING.md says" in readme


def test_again_changes_nothing(folder, capsys):
    before = files(folder)
    code, out, err = command(capsys, folder)
    assert (code, err) == (0, []) and f"{len(before) - 1} unchanged" in out[0]
    assert files(folder) == before


def test_copies_nobody_touched_are_renewed(folder, newer, capsys):
    code, out, _ = command(capsys, folder)
    assert code == 0 and out[0] == f"updated   {NOTEBOOK}"
    assert (folder / NOTEBOOK).read_bytes() == newer[NOTEBOOK]
    assert command(capsys, folder)[1][0].endswith(f"{len(newer)} unchanged")


def saved_by_jupyterlab(path, change=lambda notebook: None):
    """Save a copy as JupyterLab does, 2 minutes after a page was opened: it notes its kernel."""
    notebook = nbformat.read(path, as_version=4)
    notebook.metadata.kernelspec.display_name = "Python 3 (ipykernel)"
    notebook.metadata.language_info.update(version="3.13.1", file_extension=".py")
    change(notebook)
    nbformat.write(notebook, path)


def test_a_copy_that_was_only_opened_is_renewed(folder, newer, capsys):
    saved_by_jupyterlab(folder / NOTEBOOK)
    saved_by_jupyterlab(folder / "00_start_here.ipynb")
    opened = (folder / "00_start_here.ipynb").read_bytes()
    code, out, _ = command(capsys, folder)
    assert code == 0 and out[0] == f"updated   {NOTEBOOK}"
    assert f"1 updated, {len(newer) - 1} unchanged" in out[1]
    assert (folder / NOTEBOOK).read_bytes() == newer[NOTEBOOK]
    assert (folder / "00_start_here.ipynb").read_bytes() == opened


def test_a_copy_that_was_run_is_kept(folder, newer, capsys):
    def run(notebook):
        next(cell for cell in notebook.cells if cell.cell_type == "code").execution_count = 40

    saved_by_jupyterlab(folder / NOTEBOOK, run)
    assert command(capsys, folder)[1][0] == f"kept      {NOTEBOOK}"


@pytest.mark.parametrize("content", ["[]", "{}", '{"metadata": 1}', "[" * 9999, '{"cells": NaN}'])
def test_a_copy_that_is_no_notebook_any_more_is_kept(folder, newer, capsys, content):
    (folder / NOTEBOOK).write_text(content)
    assert command(capsys, folder)[1][0] == f"kept      {NOTEBOOK}"
    assert (folder / NOTEBOOK).read_text() == content


def test_an_edited_copy_is_kept_without_force(folder, newer, capsys):
    (folder / NOTEBOOK).write_bytes(b"my work")
    code, out, _ = command(capsys, folder)
    assert code == 0 and out[0] == f"kept      {NOTEBOOK}"
    assert "--force" in out[2]
    assert (folder / NOTEBOOK).read_bytes() == b"my work"
    assert command(capsys, folder)[1][0] == f"kept      {NOTEBOOK}", (
        "it stays edited, however often it is asked for"
    )


def test_force_replaces_an_edited_copy_and_keeps_it_beside(folder, capsys):
    for number in (1, 2):
        (folder / NOTEBOOK).write_bytes(b"my work %d" % number)
        code, out, _ = command(capsys, folder, "--force")
        name = f"03_rigid_deck_forces.edited-{number}.ipynb"
        assert code == 0 and out[0] == f"replaced  {NOTEBOOK}  (yours is now {name})"
        assert (folder / name).read_bytes() == b"my work %d" % number
        assert (folder / NOTEBOOK).read_bytes() == lessons.contents()[NOTEBOOK]
    assert (folder / "03_rigid_deck_forces.edited-1.ipynb").read_bytes() == b"my work 1"


def test_a_file_that_was_there_before_is_not_a_copy(tmp_path, capsys):
    (tmp_path / NOTEBOOK).write_bytes(b"somebody's own")
    (tmp_path / "notes.txt").write_bytes(b"notes")
    code, out, _ = command(capsys, tmp_path)
    assert code == 0 and out[0] == f"kept      {NOTEBOOK}"
    assert (tmp_path / NOTEBOOK).read_bytes() == b"somebody's own" and (
        tmp_path / "notes.txt"
    ).exists()
    assert NOTEBOOK not in json.loads((tmp_path / lessons.MANIFEST).read_text())


@pytest.mark.parametrize(
    "record", [None, "", "{", "[1]", '{"03_rigid_deck_forces.ipynb": 3}', "\udcff"]
)
def test_without_a_readable_record_every_difference_is_kept(folder, newer, capsys, record):
    if record is None:
        (folder / lessons.MANIFEST).unlink()
    else:
        (folder / lessons.MANIFEST).write_bytes(record.encode("utf-8", "surrogateescape"))
    old = (folder / NOTEBOOK).read_bytes()
    code, out, _ = command(capsys, folder)
    assert code == 0 and out[0] == f"kept      {NOTEBOOK}"
    assert (folder / NOTEBOOK).read_bytes() == old


def test_the_current_folder_will_do(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert command(capsys, ".")[0] == 0
    assert (tmp_path / NOTEBOOK).is_file() and set(files(tmp_path)) == {
        *lessons.contents(),
        lessons.MANIFEST,
    }


def test_a_deleted_copy_comes_back(folder, capsys):
    (folder / NOTEBOOK).unlink()
    assert "1 copied" in command(capsys, folder)[1][0]
    assert (folder / NOTEBOOK).is_file()


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("", "must name a folder"),
        ("a.txt", "is a file, not a folder"),
        ("a.txt/below", "cannot be written to"),
        ("\0", "cannot be written to"),
        ("full", "is a folder where a file of the suite goes"),
        ("taken", "is a file where a folder of the suite goes"),
    ],
)
def test_a_bad_folder_is_refused_in_one_line_and_nothing_is_written(
    tmp_path, monkeypatch, capsys, name, words
):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.txt").write_text("text")
    (tmp_path / "full" / NOTEBOOK).mkdir(parents=True)
    (tmp_path / "taken").mkdir()
    (tmp_path / "taken" / "data").write_text("text")
    code, out, err = command(capsys, name)
    assert (code, out, len(err)) == (2, [], 1) and words in err[0] and "DIR" in err[0]
    assert files(tmp_path) == {"a.txt": b"text", "taken/data": b"text"}
    assert {p.name for p in (tmp_path / "full").iterdir()} == {NOTEBOOK}


def test_a_folder_of_the_suite_is_refused(capsys):
    root = lessons.suite_root()
    before = sorted(p.name for p in root.iterdir())
    for own in (root, root / "notebooks", root / "data" / "new", root / "helpers" / "railbridge"):
        code, _, err = command(capsys, own)
        assert code == 2 and "belongs to the suite itself" in err[0]
    assert sorted(p.name for p in root.iterdir()) == before and not (root / "data" / "new").exists()


@pytest.mark.skipif(
    os.name == "nt" or os.geteuid() == 0, reason="the administrator may write anywhere"
)
def test_a_folder_that_may_not_be_written_to_is_refused(tmp_path, capsys):
    tmp_path.chmod(0o500)
    code, _, err = command(capsys, tmp_path / "mine")
    tmp_path.chmod(0o700)
    assert code == 2 and "cannot be written to" in err[0]


@pytest.mark.parametrize("existing", [False, True])
@pytest.mark.parametrize("error", [OSError(28, "No space left on device"), KeyboardInterrupt()])
def test_what_stops_in_the_middle_leaves_everything_as_it_was(
    folder, tmp_path, newer, capsys, monkeypatch, error, existing
):
    target = folder if existing else tmp_path / "deep" / "other"
    before = files(tmp_path)
    write, calls = type(target).write_bytes, []

    def failing(self, content):
        calls.append(self)
        if len(calls) == (1 if existing else 3):
            raise error
        return write(self, content)

    monkeypatch.setattr(type(target), "write_bytes", failing)
    code, _, err = command(capsys, target)
    assert code == (130 if isinstance(error, KeyboardInterrupt) else 1) and len(err) == 1
    assert files(tmp_path) == before and not (tmp_path / "deep").exists()


def test_copies_can_be_read_by_others(folder):
    """A temporary folder is private; what comes out of it is not."""
    if os.name != "nt":
        umask = os.umask(0)
        os.umask(umask)
        assert folder.stat().st_mode & 0o777 == 0o777 & ~umask
        assert (folder / NOTEBOOK).stat().st_mode & 0o777 == 0o666 & ~umask


def test_an_installation_without_notebooks_says_so(tmp_path, monkeypatch):
    monkeypatch.setattr(lessons, "suite_root", lambda: tmp_path)
    with pytest.raises(rb.InputError, match="are missing from this installation"):
        lessons.contents()


# ---- editions


def test_a_student_gets_neither_solutions_nor_the_teachers_page(tmp_path, capsys):
    assert command(capsys, tmp_path / "class", "--student")[0] == 0
    names = {p.relative_to(tmp_path / "class").as_posix() for p in (tmp_path / "class").rglob("*")}
    assert "docs/teaching.md" not in names and "sheets" not in names
    for path in (tmp_path / "class").glob("*.ipynb"):
        text = path.read_text(encoding="utf-8")
        assert "<summary>Solution" not in text and '"output_type"' not in text
        assert "teaching.md)" not in text, "no link to what a student does not get"


def test_a_teacher_gets_the_page_and_sheets_to_print(tmp_path, capsys):
    assert command(capsys, tmp_path / "mine", "--teacher")[0] == 0
    assert (tmp_path / "mine" / "docs" / "teaching.md").exists()
    sheets = sorted(path.name for path in (tmp_path / "mine" / "sheets").iterdir())
    assert sheets == ["guess_sheet.html", "numbers_A.html", "numbers_B.html"]


def test_another_edition_renews_what_nobody_edited(tmp_path, capsys):
    assert command(capsys, tmp_path / "mine", "--teacher")[0] == 0
    edited = tmp_path / "mine" / NOTEBOOK
    edited.write_bytes(b"my work")
    code, out, _ = command(capsys, tmp_path / "mine", "--student")
    assert code == 0 and f"kept      {NOTEBOOK}" in out
    assert edited.read_bytes() == b"my work"


def test_a_copy_is_of_one_edition(tmp_path, capsys):
    with pytest.raises(SystemExit) as stop:
        command(capsys, tmp_path / "mine", "--teacher", "--student")
    assert stop.value.code == 2
