"""``stackloft plugins list`` and ``show``."""

import json


def test_every_built_in_is_listed_and_sound(stackloft):
    rows = json.loads(stackloft("plugins", "list", "--json").stdout)
    own = {(row["family"], row["name"]) for row in rows if row["distribution"] == "stackloft"}
    for plugin in [("reader", "photos"), ("reconstructor", "loft"), ("writer", "ply"), ("recipe", "frustum")]:
        assert plugin in own
    assert {row["state"] for row in rows if row["distribution"] == "stackloft"} == {"ok"}


def test_the_table_has_a_line_for_each(stackloft):
    lines = stackloft("plugins", "list").stdout.splitlines()
    assert lines[0].split() == ["family", "name", "distribution", "version", "state"]
    assert len(lines) - 1 == len(json.loads(stackloft("plugins", "list", "--json").stdout))


def test_show_gives_options_with_unit_bounds_default_and_source(stackloft):
    run = stackloft("plugins", "show", "reconstructor.loft")
    for word in ("points", "33", "≥ 5", "Goñi, Purlis & Salvadori (2007)", "height", "mm", "ContourStack"):
        assert word in run.stdout, word


def test_show_as_json_names_the_same_options(stackloft):
    (details,) = json.loads(stackloft("plugins", "show", "writer.stl", "--json").stdout)
    (option,) = details["options"]
    assert (option["name"], option["unit"], option["bounds"]) == ("tolerance", "mm", {"gt": 0})


def test_a_name_in_several_families_shows_all_of_them(stackloft):
    rows = json.loads(stackloft("plugins", "show", "loft", "--json").stdout)
    assert {row["family"] for row in rows} == {"reconstructor", "recipe"}


def test_an_unknown_name_is_one_line_with_the_nearest(stackloft):
    run = stackloft("plugins", "show", "hystogram")
    assert run.returncode == 1
    assert run.stderr == "stackloft: no plug-in is called 'hystogram'; fix: did you mean histogram?\n"
