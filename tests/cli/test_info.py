"""``stackloft info`` says what was read and measures nothing."""

import json
import shutil


def test_a_folder_of_photographs(stackloft, ball_folder):
    run = stackloft("info", ball_folder)
    assert run.returncode == 0, run.stderr
    for word in ("photos", "9 (face)", "cut_1.png", "130 × 110", "0.5 mm (stack.toml)", "none seen"):
        assert word in run.stdout, word


def test_json_lists_order_and_positions(stackloft, ball_folder):
    facts = json.loads(stackloft("info", ball_folder, "--json", "--thickness", "3mm").stdout)
    assert facts["schema"] == "stackloft.info/1"
    assert facts["order"] == [f"cut_{number}.png" for number in range(1, 10)]
    assert facts["positions"] == [3.0 * number for number in range(9)]
    assert facts["pixels"] == [110, 130]
    assert facts["provenance"]["positions"] == "--thickness"
    assert facts["hazards"] == []


def test_a_skipped_slice_is_a_hazard(stackloft, ball_folder, tmp_path):
    folder = tmp_path / "ball"
    shutil.copytree(ball_folder, folder)
    with (folder / "stack.toml").open("a") as stream:
        stream.write("[slice.4]\nskip = true\n")
    run = stackloft("info", folder)
    assert "slice-skipped" in run.stdout
    assert "cut_4.png" in run.stdout


def test_exact_contours(stackloft, tmp_path):
    stackloft("phantom", "cone", "--as", "contours", "-o", tmp_path, "--sections", "4")
    facts = json.loads(stackloft("info", tmp_path / "contours.csv", "--json").stdout)
    assert facts["reader"] == "contours"
    assert facts["loops"] == [1, 1, 1, 1]
    assert facts["exact"] is True


def test_what_cannot_be_read_is_one_line(stackloft, tmp_path):
    run = stackloft("info", tmp_path)
    assert run.returncode == 1
    assert run.stderr.count("\n") == 1
    assert "empty folder" in run.stderr


def test_a_flag_of_the_method_is_no_flag_of_info(stackloft, ball_folder):
    assert stackloft("info", ball_folder, "--points", "40").returncode == 2
