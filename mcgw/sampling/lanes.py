"""Four numbers at a time, and multiply-adds that are rounded once: the same bits on every processor.

Left to itself, a compiler takes as many terms of a sum at a time as the vector unit of this machine holds,
and fuses multiplications and additions where the machine can: each kind of processor then rounds otherwise.
Here both are written out. Four numbers are one register since 2013 and two before; a machine that cannot
fuse calls a function of the C library that rounds alike, and is slow.
"""

import operator
from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.typing.templates import ConcreteTemplate, infer_global, signature
from numba.extending import intrinsic, lower_builtin, models, register_model

LANES = 4

_DOUBLE = ir.DoubleType()
_VECTOR = ir.VectorType(_DOUBLE, LANES)
_ALIGNED = 8  # bytes: a vector may begin at any number


class _Lanes(types.Type):
    """Numba's type of four numbers."""

    def __init__(self) -> None:
        super().__init__(name="lanes")


_lanes = _Lanes()


@register_model(_Lanes)
class _LanesModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, _VECTOR)


class _LaneByLane(ConcreteTemplate):
    cases = [signature(_lanes, _lanes, _lanes)]  # noqa: RUF012 - as numba wants it


def _operate(operators: tuple[Any, ...], name: str) -> None:
    """Have operators mean an instruction, lane by lane."""

    def code(_context: Any, builder: Any, _sig: Any, args: Any) -> Any:
        return getattr(builder, name)(*args)

    for one in operators:
        infer_global(one)(_LaneByLane)
        lower_builtin(one, _lanes, _lanes)(code)


_operate((operator.add, operator.iadd), "fadd")
_operate((operator.sub, operator.isub), "fsub")
_operate((operator.mul, operator.imul), "fmul")


def intrinsic_of(function: Callable[..., Any]) -> Any:
    """Make a function of code that writes instructions; what it takes is not what its caller gives."""
    return intrinsic(function)


def called(builder: Any, name: str, *args: Any) -> Any:
    """Call one of LLVM's own functions, of numbers or of lanes."""
    kind = args[0].type
    suffix = "f64" if kind == _DOUBLE else f"v{LANES}f64"
    function = ir.FunctionType(kind, [kind] * len(args))
    return builder.call(cgutils.get_or_insert_function(builder.module, function, f"{name}.{suffix}"), args)


def place(context: Any, builder: Any, array_type: Any, array: Any) -> Callable[..., Any]:
    """Pointer by index, counted through all rows of an array in C's order, to `one` number or to lanes."""
    if array_type.layout != "C":
        raise TypeError(f"lanes are neighbours: not of {array_type}")
    data = context.make_array(array_type)(context, builder, array).data

    def at(index: Any, *, one: bool = False) -> Any:
        number = builder.gep(data, [index])
        return number if one else builder.bitcast(number, _VECTOR.as_pointer())

    return at


def same(number: float) -> Any:
    """A constant in each lane."""
    return ir.Constant(_VECTOR, [number] * LANES)


def sum_of(builder: Any, lanes: Any) -> Any:
    """Sum of the lanes, in one order: ``(0 + 2) + (1 + 3)``."""
    x = [builder.extract_element(lanes, ir.IntType(32)(i)) for i in range(LANES)]
    return builder.fadd(builder.fadd(x[0], x[2]), builder.fadd(x[1], x[3]))


@intrinsic_of
def fused(_typing: Any, a: Any, b: Any, c: Any) -> Any:
    """``a b + c``, rounded once; of numbers or of lanes."""

    def code(_context: Any, builder: Any, _sig: Any, args: Any) -> Any:
        return called(builder, "llvm.fma", *args)

    return a(a, b, c), code


@intrinsic_of
def roots(_typing: Any, a: Any) -> Any:
    """Square root of each lane."""

    def code(_context: Any, builder: Any, _sig: Any, args: Any) -> Any:
        return called(builder, "llvm.sqrt", *args)

    return a(a), code


@intrinsic_of
def alike(_typing: Any, _number: Any) -> Any:
    """The same number in each lane."""

    def code(_context: Any, builder: Any, _sig: Any, args: Any) -> Any:
        one = builder.insert_element(ir.Constant(_VECTOR, ir.Undefined), args[0], ir.IntType(32)(0))
        mask = ir.Constant(ir.VectorType(ir.IntType(32), LANES), [0] * LANES)
        return builder.shuffle_vector(one, one, mask)

    return _lanes(types.float64), code


@intrinsic_of
def load(_typing: Any, array: Any, _index: Any) -> Any:
    """Numbers `index` ... `index + 3` of a contiguous array."""

    def code(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        return builder.load(place(context, builder, sig.args[0], args[0])(args[1]), align=_ALIGNED)

    return _lanes(array, types.intp), code


@intrinsic_of
def store(_typing: Any, array: Any, _index: Any, value: Any) -> Any:
    """Write them."""

    def code(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        builder.store(args[2], place(context, builder, sig.args[0], args[0])(args[1]), align=_ALIGNED)
        return context.get_dummy_value()

    return types.void(array, types.intp, value), code


@intrinsic_of
def total(_typing: Any, a: Any) -> Any:
    """`sum_of` the lanes."""

    def code(_context: Any, builder: Any, _sig: Any, args: Any) -> Any:
        return sum_of(builder, *args)

    return types.float64(a), code


@intrinsic_of
def bits(_typing: Any, a: Any) -> Any:
    """The word that holds a number: sign, exponent, fraction."""

    def code(_context: Any, builder: Any, _sig: Any, args: Any) -> Any:
        return builder.bitcast(args[0], ir.IntType(64))

    return types.int64(a), code


@intrinsic_of
def number(_typing: Any, _word: Any) -> Any:
    """The number that a word holds: the way back."""

    def code(_context: Any, builder: Any, _sig: Any, args: Any) -> Any:
        return builder.bitcast(args[0], _DOUBLE)

    return types.float64(types.int64), code
