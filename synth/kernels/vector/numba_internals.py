"""The door to numba's extension interface and to llvmlite, and all that is undocumented in what stands on them.

No other file may import `llvmlite`, `numba.core` or the low-level part of `numba.extending`; tests/architecture holds
that. The tests pass with numba 0.68.1 and llvmlite 0.50.0, which requirements.lock names. With numba 0.68.0 the tests
of packs and closed loop pass, and the coefficients of 86 tables are the same. pyproject.toml allows these minor
releases alone.

What packs need is in numba's documented low-level interface: `intrinsic`, `register_model`, `type_callable`,
`lower_builtin`, `create_struct_proxy`; and llvmlite's builders of machine code, `ir`.

Undocumented are four options and a name. `RETARDER_SYNTH_PLAIN_KERNELS=1` (`kernels.plain`) leaves the options out, so
that a numba that no longer has them stops nobody: kernels give the same bits, but slower.

- `WITHOUT_REFERENCE_COUNTS`: without it kernels take longer;
- `IN_ITS_CALLERS`: without it too;
- `WITHOUT_CALLBACK`: without it kernels do the same, but take longer to compile;
- `compiled_part`, which keeps numba from making a function that Python can call: without it too;
- `CACHE_READER`, the name of numba's module for cached kernels: without it `guarded` mends no damaged cache.

A new release of numba: read its list of changes, run `.ci/newest`, raise the cap in pyproject.toml, and lock anew.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from llvmlite import ir
from numba import extending, njit
from numba.core import cgutils

from synth.kernels.plain import IS_PLAIN

__all__ = [
    "CACHE_READER",
    "IN_ITS_CALLERS",
    "WITHOUT_CALLBACK",
    "WITHOUT_REFERENCE_COUNTS",
    "array_data",
    "compiled_part",
    "declared_function",
    "infer_operation",
    "intrinsic",
    "ir",
    "lower_operation",
    "register_vector",
]


def undocumented(**options: Any) -> dict[str, Any]:
    """Options of `njit` that numba does not promise; none where its inside is left alone.

    An unknown option is refused when the kernel is decorated, so a numba without it cannot go unnoticed.
    """
    return {} if IS_PLAIN else options


WITHOUT_REFERENCE_COUNTS = undocumented(_nrt=False)
"""For kernels that neither make an array nor keep one: numba's runtime is left out."""

WITHOUT_CALLBACK = undocumented(no_cfunc_wrapper=True)
"""Also for `overload`: numba makes no second function of it that C could call back.

Nothing here is handed to C, and to make these took a sixth of the time of compiling.
"""

IN_ITS_CALLERS = undocumented(forceinline=True)
"""The machine code is put into the callers, whatever its size."""


def compiled_part(function: Callable[..., Any], options: Mapping[str, Any]) -> Any:
    """`function` compiled with `options` of `njit` for kernels alone; a `TypeError` for who calls it from Python.

    What numba makes of a function for Python took a fifth of the time of compiling. A call of what was not made would
    end the process, so no call is given to it.
    """

    def refused(*_arguments: Any, **_named: Any) -> Any:
        raise TypeError(f"{function.__name__} is a part of kernels; from Python call {function.__name__}.py_func")

    compiler: Any = njit
    if IS_PLAIN:
        return compiler(**options)(function)
    made = compiler(**options, no_cpython_wrapper=True)(function)
    made._insert = lambda *_arguments, **_named: None
    made._compile_for_args = refused
    return made


CACHE_READER = "numba.core.caching"
"""The module that reads cached kernels: an error raised in it means that the cache is damaged."""

intrinsic: Any = extending.intrinsic
"""Decorator of a function that gives the type of a call and the code for it.

numba's own type of it counts the typing context among the arguments of a call, hence `Any`.
"""


def register_vector(kind: type, machine_type: Callable[[Any], Any]) -> None:
    """Have values of the numba type `kind` live in one LLVM value of the type `machine_type(instance)`."""

    class Model(extending.models.PrimitiveModel):
        def __init__(self, manager: Any, instance: Any) -> None:
            super().__init__(manager, instance, machine_type(instance))

    extending.register_model(kind)(Model)


def infer_operation(symbol: Callable[..., Any], result: Callable[[Any, Any], Any]) -> None:
    """Have the binary operation `symbol` give the type `result(a, b)` of its operands' types; None: not ours."""
    typed: Any = extending.type_callable(symbol)
    typed(lambda context: lambda a, b: result(a, b))


def lower_operation(symbol: Callable[..., Any], kinds: tuple[type, type], code: Callable[..., Any]) -> None:
    """Generate the binary operation `symbol` of operands of `kinds` by `code(context, builder, signature, values)`."""
    extending.lower_builtin(symbol, *kinds)(code)


def declared_function(builder: Any, name: str, result: Any, arguments: list[Any]) -> Any:
    """The function `name` of LLVM or of the C library, declared in the module that is being built."""
    known = builder.module.globals.get(name)
    return known or ir.Function(builder.module, ir.FunctionType(result, arguments), name)


def array_data(context: Any, builder: Any, array_type: Any, array: Any) -> Any:
    """Code for the address of the first element of an array."""
    return cgutils.create_struct_proxy(array_type)(context, builder, value=array).data
