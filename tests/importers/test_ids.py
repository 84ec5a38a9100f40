import pytest

from importers.ids import decode_id


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ("Left_x5F_hole_1_", "Left_hole"),
        ("north_wall", "north wall"),
        ("_x23_4", "#4"),
        ("caf_xE9_", "caf\u00e9"),
        ("half_xD800_", "half_xD800_"),  # half of a pair is no character, and cannot be printed
        ("over_x110000_", "over_x110000_"),
    ],
)
def test_ids_are_what_their_owner_wrote(written, meant):
    assert decode_id(written) == meant


def test_blanks_and_second_uses_are_only_illustrators():
    assert decode_id("north_wall_1_", illustrator=False) == "north_wall_1_"
