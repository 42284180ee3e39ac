"""What a record's field is follows from the part that declares it, for fields to come as well."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest

from slipgym.contact import records
from slipgym.contact.fields import comparison, elements, joined, reset, transfer
from slipgym.contact.records import PAD, PAD_PARAMETERS, PAD_SCRATCH, PAD_STATE, pads, rest, same_pads
from slipgym.world.records import FINGER, FINGER_PARAMETERS, FINGER_STATE, copy_finger_state, same_fingers

MOVED = np.dtype([("speed", "f8"), ("place", "f8", 2), ("turns", "i8", (2, 2))])
LOOKS = np.dtype([("colour", "i8")])


def test_a_record_has_the_fields_of_its_parts_in_their_order():
    both = joined(MOVED, LOOKS)
    assert both.names == ("speed", "place", "turns", "colour")
    assert both["turns"].shape == (2, 2)
    names = ["turns[0, 0]", "turns[0, 1]", "turns[1, 0]", "turns[1, 1]"]
    assert elements(MOVED, LOOKS) == ["speed", "place[0]", "place[1]", *names, "colour"]


def test_generated_functions_go_over_all_elements_of_their_parts_and_no_others():
    both = np.zeros(2, joined(MOVED, LOOKS))
    both["colour"] = 1, 2
    same = comparison("same_moved", (MOVED,), __file__, "Whether two agree.")
    assert same(both[0], both[1])
    both["turns"][0, 1, 1] = 7
    assert not same(both[0], both[1])
    transfer("copy_moved", (MOVED,), __file__, "Copies.")(both[0], both[1])
    assert both["turns"][1].tolist() == [[0, 0], [0, 7]]
    assert both["colour"].tolist() == [1, 2]
    reset("reset_moved", (MOVED,), {"speed": "2.0 * record.colour"}, __file__, "Resets.")(both[1])
    assert both[1].tolist()[0] == 4.0
    assert both["turns"][1].tolist() == [[0, 0], [0, 0]]


@pytest.mark.parametrize("name", PAD.names)
def test_pads_are_the_same_if_all_but_scratch_is(name):
    array = pads(2, mu_c=0.3, mu_s=0.4, r=0.01)
    assert same_pads(array[0], array[1])
    array[name].reshape(2, -1)[1, -1] = 7
    assert same_pads(array[0], array[1]) == (name in PAD_SCRATCH.names)


@pytest.mark.parametrize("name", FINGER.names)
def test_fingers_are_the_same_if_parameters_and_state_are(name):
    fingers = np.zeros(2, FINGER)
    fingers[name][1] = 7
    compared = name in (*FINGER_PARAMETERS.names, *FINGER_STATE.names)
    assert same_fingers(fingers[0], fingers[1]) == (not compared)
    copy_finger_state(fingers[1], fingers[0])
    assert np.array_equal(fingers[name][0], fingers[name][1]) == (name in FINGER_STATE.names)


@pytest.mark.parametrize("part", ["PAD_FIXED", "PAD_EPISODE", "PAD_STATE", "PAD_SCRATCH"])
def test_a_field_to_come_counts_as_its_part_says(part, tmp_path):
    source = Path(records.__file__).read_text()
    start = f"{part} = np.dtype(\n    [\n"
    assert start in source
    path = tmp_path / "records_to_come.py"
    path.write_text(source.replace(start, start + '        ("wear", "f8", 2),\n'))
    spec = importlib.util.spec_from_file_location("records_to_come", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    array = module.pads(2)
    assert module.same_pads(array[0], array[1])
    array["wear"][0, 1] = 1e-9
    assert module.same_pads(array[0], array[1]) == (part == "PAD_SCRATCH")
    module.rest(array)
    assert module.same_pads(array[0], array[1]) == (part in ("PAD_STATE", "PAD_SCRATCH"))


def test_rest_forgets_all_state_and_scratch_but_the_normal_force():
    used = pads(1, mu_c=0.3, mu_s=0.4, r=0.01, cop=(1e-3, 2e-3))
    fresh = used.copy()
    for name in (*PAD_STATE.names, *PAD_SCRATCH.names):
        used[name] = 3
    rest(used)
    assert used["normal"] == 3.0
    used["normal"] = fresh["normal"]
    assert used.tobytes() == fresh.tobytes()
    assert len({*PAD_PARAMETERS.names, *PAD_STATE.names, *PAD_SCRATCH.names}) == len(PAD.names)
