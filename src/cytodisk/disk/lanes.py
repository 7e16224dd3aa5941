"""Four numbers at once: the innermost loop of the factors of 3×3 blocks.

The compiler does not find by itself that the three numbers of a row could go together; with the processor's
vectors of four numbers the factors take two thirds of the time.
"""

from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

ROW = 4
"""Numbers that a row of three takes where it is to be worked on at once; the last is 0."""


def _take_off_column(
    typing: Any, work: Any, column: Any, factor: Any, below: Any, first: Any, stop: Any
) -> tuple[Any, Any]:
    signature = types.void(work, types.intp, factor, below, types.intp, types.intp)

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        row_type = ir.VectorType(ir.DoubleType(), ROW)
        to_all = ir.Constant(ir.VectorType(ir.IntType(32), ROW), [0] * ROW)
        nothing = ir.Constant(row_type, ir.Undefined)

        def index(number: int) -> Any:
            return context.get_constant(types.intp, number)

        def data(which: int) -> Any:
            return context.make_array(signature.args[which])(context, builder, arguments[which]).data

        def row_of(block: Any, row: int) -> Any:
            at = builder.add(builder.mul(block, index(3 * ROW)), index(ROW * row))
            return builder.bitcast(builder.gep(data(0), [at]), row_type.as_pointer())

        column, first, stop = arguments[1], arguments[4], arguments[5]
        minus = [builder.fneg(builder.load(row_of(column, r), align=8)) for r in range(3)]
        with cgutils.for_range_slice(builder, first, stop, index(1)) as (block, _):
            under = builder.load(builder.gep(data(3), [block]))
            for p in range(3):
                place = row_of(under, p)
                left = builder.load(place, align=8)
                for r in range(3):
                    at = builder.add(builder.mul(block, index(9)), index(3 * p + r))
                    one = builder.load(builder.gep(data(2), [at]))
                    four = builder.insert_element(nothing, one, ir.Constant(ir.IntType(32), 0))
                    four = builder.shuffle_vector(four, nothing, to_all)
                    product = builder.fmul(four, minus[r], flags=("contract",))
                    left = builder.fadd(product, left, flags=("contract",))
                builder.store(left, place, align=8)
        return context.get_dummy_value()

    return signature, generate


take_off_column: Any = intrinsic(_take_off_column)
"""Called as (work, column, factor, below, first, stop): work[below[b]] -= factor[b] @ work[column] for the
blocks b from `first` to `stop`.

`work` has 3 × `ROW` numbers a block and `factor` 9, in C order; no block is that of `column`.
"""
