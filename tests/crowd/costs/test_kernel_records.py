"""Kernels ask for records by name, and find in them what they are said to hold."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numba import njit

from mesa_mobility import CompiledTerm, Me, Option, Options, Other, Wall, option_kernel, pair_kernel
from mesa_mobility.crowd.costs.kernel_arguments import reads_of
from mesa_mobility.crowd.costs.kernel_calls import call_bound_loop
from mesa_mobility.crowd.costs.layout import FIELDS
from mesa_mobility.crowd.costs.records import RECORDS
from mesa_mobility.crowd.planning.evaluation.term_table import compile_terms, fields_of
from mesa_mobility.errors import ModelError
from tests.fixtures.maps import strider
from tests.fixtures.options import Ending, one_option
from tests.fixtures.scenes import corridor, model_of, put


class Field(CompiledTerm):
    """The value of one field, by its place in the record."""

    name = "field"
    field = 0


@option_kernel
def _of_option(option, p):
    return option[int(p.field)]


@option_kernel
def _of_me(me, p):
    return me[int(p.field)]


@pair_kernel
def _of_other(p, other):
    return other[int(p.field)]


@option_kernel
def _of_wall(wall, p):
    return wall[int(p.field)]


@option_kernel
def _of_options(options, p):
    return options[int(p.field)]


def scene():
    """An option of 1.5 m in 0.5 s, somebody who walks, one neighbour, and one wall."""
    made = one_option(
        Ending((3.0, 4.0), math.pi / 2, 1.5, 0.5),
        target=(9.0, 8.0),
        position=(2.0, 1.0),
        preferred_speed=1.25,
        velocity=(0.75, -0.5),
        core=0.2,
        walls=[(0.0, 5.0, 6.0, 7.0)],
        neighbours=[((2.5, 3.5), (-1.0, 0.25), (0.6, 0.8), 1.75)],
    )
    return replace(
        made,
        facings=np.array([0.3]),
        types=np.array([2]),
        groups=np.array([4]),
        neighbour_facings=np.array([0.7]),
        neighbour_types=np.array([1]),
        neighbour_groups=np.array([5]),
        neighbour_cores=np.array([0.25]),
    )


VALUES = [
    (_of_option, Option(3.0, 4.0, 0.0, 1.0, 0.5, 3.0)),
    (_of_me, Me(2.0, 1.0, 9.0, 8.0, 1.25, 0.75, -0.5, 0.2, math.hypot(0.5, 2.5), 0.3, 2.0, 4.0)),
    (_of_other, Other(2.5, 3.5, -1.0, 0.25, 0.6, 0.8, 1.75, 0.25, 0.7, 1.0, 5.0)),
    (_of_wall, Wall(0.0, 5.0, 6.0, 7.0)),
]


@pytest.mark.parametrize(("kernel", "expected"), VALUES)
def test_each_field_has_its_value(kernel, expected):
    class Own(Field):
        pass

    Own.kernel = kernel
    options, term, found = scene(), Own(), []
    for field in range(len(expected)):
        term.field = field
        found += term.cost(options).tolist()
    # A wall counts where its cost is more than 0, and all of these are 0 or more.
    assert type(expected)(*found) == pytest.approx(expected, abs=1e-12)


@njit
def _bound(address, ends, groups, own, at, numbers, out):
    call_bound_loop(address, (1, ends, groups, own, at, numbers, 1.0, out))


def test_each_field_of_a_group_has_its_value():
    expected = Options(3.0, 4.0, 0.2, 0.6, 0.8, 0.1, 0.5, 1.0, 2.0)
    # Ends and groups of which the second counts; places of groups are those of a map.
    ends = np.array([[9.0, v] for v in (3.0, 4.0, 0.6, 0.8, 9.0, 9.0)])
    groups = np.array([[9.0, v] for v in (9.0, 9.0, 0.2, 9.0, 9.0, 0.1, 0.5, 1.0, 2.0)])
    found = []
    for field in range(len(expected)):
        out = np.zeros(1)
        numbers, at = np.array([field, 0.0]), np.zeros(1, dtype=np.int64)
        _bound(_of_options.address, ends[:, 1:], groups[:, 1:], np.zeros(8), at, numbers, out)
        found.append(float(out[0]))
    assert Options(*found) == expected


def test_no_record_has_more_than_twelve_fields():
    assert max(len(record._fields) for record in RECORDS.values()) <= 12
    assert list(RECORDS) == [record.__name__.lower() for record in RECORDS.values()]


def test_records_come_in_any_order_and_number():
    @option_kernel
    def swapped(p, me, option):
        return p.factor * (option.x - me.x)

    class Swapped(CompiledTerm):
        name = "swapped"
        kernel = swapped
        factor = 2.0

    @option_kernel
    def nothing():
        return 0.5

    class Nothing(CompiledTerm):
        name = "nothing"
        kernel = nothing

    assert Swapped().cost(scene()).tolist() == [2.0]
    assert Nothing().cost(scene()).tolist() == [0.5]


def test_only_fields_that_are_read_are_laid_out():
    assert _of_option.fields == ()
    assert _of_me.fields == ("heading", "type", "group")
    assert _of_other.fields == ("core", "heading", "type", "group")

    @pair_kernel(fields=("mood",))
    def some(me, other):
        return me.core + other.group + me.mood

    assert some.fields == ("group", "mood")
    assert some.of_others == ("group",)


def test_fields_that_are_read_of_the_pedestrian_alone_come_last():
    @pair_kernel(fields=("mood", "haste"))
    def one(me, other):
        return me.type + me.mood + other.haste

    @pair_kernel(fields=("haste",))
    def more(me, other):
        return other.core + me.haste

    class One(CompiledTerm):
        name = "one"
        kernel = one

    class More(CompiledTerm):
        name = "more"
        kernel = more

    assert fields_of([One(), More()]) == (["haste", "core", "type", "mood"], 2)
    terms, _ = compile_terms([One(), More()])
    assert terms.of_others == 2
    assert terms.pair.fields.tolist() == [[FIELDS + 2, FIELDS + 3, FIELDS], [FIELDS + 1, FIELDS, 0]]


def refused(made, function, **given):
    with pytest.raises(ModelError) as error:
        made(**given)(function) if given else made(function)
    assert "\n" not in str(error.value)
    return str(error.value)


def test_an_argument_that_there_is_not_is_refused_by_name():
    def misspelt(optoin, me):
        return 0.0

    def alone(qux):
        return 0.0

    said = "kernel misspelt: no record 'optoin', did you mean 'option'?"
    assert refused(option_kernel, misspelt) == said
    said = "kernel alone: no record 'qux', expected any of option, me, other, p"
    assert refused(pair_kernel, alone) == said

    def beside(option, other):
        return 0.0

    def fence(option, wall):
        return 0.0

    def both(options, wall):
        return 0.0

    said = "kernel beside: takes other, which is for a pair_kernel"
    assert refused(option_kernel, beside) == said
    assert refused(pair_kernel, fence).startswith("kernel fence: no record 'wall'")
    assert refused(option_kernel, both).startswith("kernel both: no record 'wall'")

    def many(*records):
        return 0.0

    def named(*, option):
        return 0.0

    for function in (many, named):
        assert "expected arguments of its own, any of option, me, p" in refused(
            option_kernel, function
        )


def test_a_kernel_of_loose_numbers_is_told_the_new_form():
    def keep_left(x, y, ux, uy, duration, speed, sx, sy, tx, ty, preferred, p):
        return p[0] * x

    assert refused(option_kernel, keep_left) == (
        "kernel keep_left: takes loose numbers (x, y, ux, ...), expected records: "
        "def keep_left(option, me, p), with option.x, me.target_x, p.name"
    )
    assert "def keep_left(option, me, other, p), with" in refused(pair_kernel, keep_left)


def test_a_field_that_there_is_not_is_refused_by_name():
    def targt(me):
        return me.targt_x

    def tall(wall):
        return wall.height

    def moody(option, other):
        return other.mood

    said = "kernel targt: no field 'targt_x' of me, did you mean 'target_x'?"
    assert refused(option_kernel, targt).startswith(said)
    said = "kernel tall: no field 'height' of wall, it has x1, y1, x2, y2"
    assert refused(option_kernel, tall) == said
    asks = "a field of the model is asked for by fields=('mood',)"
    assert refused(pair_kernel, moody).endswith(asks)
    assert pair_kernel(fields=["mood"])(moody).fields == ("mood",)
    assert "no field 'mood' of other" in refused(pair_kernel, moody, fields=["infected"])


@njit
def _height(record):
    return record.height


def test_a_field_that_there_is_not_in_another_function_is_refused_when_it_is_compiled():
    @option_kernel
    def tall(wall):
        return _height(wall)

    with pytest.raises(ModelError, match=r"^kernel tall: no field 'height' of wall$"):
        _ = tall.address


def test_the_term_is_read_by_names():
    def first(p):
        return p[0]

    def handed_on(p):
        return _height(p)

    def private(p):
        return p._width

    def kept(p):
        own = p
        return own.width

    for function in (first, handed_on, private, kept):
        assert "reads p otherwise than by a name, expected such as p.width" in refused(
            option_kernel, function
        )


def test_an_attribute_that_the_term_does_not_have_is_refused_by_name():
    @option_kernel
    def wide(option, p):
        return p.widht * option.speed

    class Wide(CompiledTerm):
        name = "wide"
        kernel = wide
        width = 1.0

    says = r"'wide': its kernel reads p\.widht, but it has no attribute 'widht', did you mean 'wid"
    with pytest.raises(ModelError, match=says):
        Wide().cost(scene())
    model = model_of(corridor(), strider(), behaviors=[Wide()])
    put(model, 2.0, 2.0)
    with pytest.raises(ModelError, match=says):
        model.step()


def test_how_arguments_are_used():
    def uses(me, p):
        more = me.x + me.y if p.width > p.depth else me.x
        return _height(me) + more * p.width

    assert reads_of(uses, "me") == (("x", "y"), True)
    assert reads_of(uses, "p") == (("width", "depth"), False)

    def inner(me, p):
        return sum(p.width for _ in range(3)) + me.x

    assert reads_of(inner, "p").whole
    assert reads_of(inner, "me") == (("x",), False)
