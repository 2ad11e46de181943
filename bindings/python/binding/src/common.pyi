"""Mechanical systems, stepped as NumPy arrays. Written by `stub()` of the module."""

from collections.abc import Callable, Sequence
from os import PathLike
from pathlib import Path
from typing import Any, ClassVar, Self, TypedDict, final, overload

import numpy as np
import numpy.typing as npt
from typing_extensions import disjoint_base

type _Array = npt.NDArray[np.float64]
type _Numbers = Sequence[float] | Sequence[Sequence[float]] | npt.NDArray[np.floating[Any] | np.integer[Any]]

type _Event = Plane | Sphere | Energy | Event | Callable[[float, _Array, _Array], float]

__version__: str

@final
class Breach:
    """Where the error expected of a run has passed the tolerance."""

    @property
    def t(self) -> float:
        """The time."""
    @property
    def expected(self) -> float:
        """The error expected of the state there."""
    @property
    def tolerance(self) -> float:
        """The tolerance."""
    @property
    def instead(self) -> float:
        """A tolerance to ask for instead, from the start."""

@final
class Crossings:
    """When an event function vanished, and where the motion was: one row an event."""

    @property
    def member(self) -> npt.NDArray[np.int64] | None:
        """The number of the member of each, shape (events,); None of a run."""
    @property
    def t(self) -> _Array:
        """Times, shape (events,)."""
    @property
    def q(self) -> _Array:
        """Configurations, shape (events, n)."""
    @property
    def v(self) -> _Array:
        """Velocities, shape (events, n)."""
    @property
    def p(self) -> _Array:
        """Momenta, shape (events, n)."""
    def __len__(self) -> int: ...

@final
class Table:
    """A curve through points, for a field that is one."""

    @staticmethod
    def linear(x: _Numbers, y: _Numbers, *, straight_beyond: bool = False) -> Table:
        """Straight lines between the points."""
    @staticmethod
    def spline(x: _Numbers, y: _Numbers, *, straight_beyond: bool = False) -> Table:
        """Cubics with continuous second derivatives, as SciPy's CubicSpline."""
    @staticmethod
    def monotone(x: _Numbers, y: _Numbers, *, straight_beyond: bool = False) -> Table:
        """Cubics that turn at points alone, as SciPy's PchipInterpolator."""
    @staticmethod
    def periodic(x: _Numbers, y: _Numbers) -> Table:
        """The periodic spline, which goes on for ever; the last y is the first."""
    @property
    def x(self) -> _Array:
        """The x of the points."""
    @property
    def y(self) -> _Array:
        """The y of the points."""
    @property
    def interpolation(self) -> str:
        """The interpolation between the points: "linear", "spline", "monotone" or "periodic"."""
    @property
    def straight_beyond(self) -> bool:
        """Whether the curve goes on by its slope beyond its ends."""
    @overload
    def __call__(self, x: float) -> float: ...
    @overload
    def __call__(self, x: _Numbers) -> _Array:
        """The values at x, a number or an array."""
    def __eq__(self, other: object, /) -> bool: ...

@final
class Plane:
    """A plane that a run crosses: q·a + v·b = value."""

    def __new__(
        cls,
        q: Sequence[float],
        v: Sequence[float] | None = None,
        *,
        value: float = 0.0,
        direction: float = 0.0,
        terminal: bool = False,
    ) -> Self: ...
    @property
    def q(self) -> list[float]:
        """a."""
    @property
    def v(self) -> list[float] | None:
        """b."""
    @property
    def value(self) -> float:
        """The right side."""
    @property
    def direction(self) -> float:
        """Which crossings count."""
    @property
    def terminal(self) -> bool:
        """Whether the run ends there."""

@final
class Sphere:
    """A sphere in the space of configurations that a run crosses: |q − center| = radius."""

    def __new__(
        cls, center: Sequence[float], radius: float, *, direction: float = 0.0, terminal: bool = False
    ) -> Self: ...
    @property
    def center(self) -> list[float]:
        """Its centre."""
    @property
    def radius(self) -> float:
        """Its radius."""
    @property
    def direction(self) -> float:
        """Which crossings count."""
    @property
    def terminal(self) -> bool:
        """Whether the run ends there."""

@final
class Energy:
    """An energy v·∂L/∂v − L that a run passes."""

    def __new__(cls, value: float, *, direction: float = 0.0, terminal: bool = False) -> Self: ...
    @property
    def value(self) -> float:
        """The energy."""
    @property
    def direction(self) -> float:
        """Which passages count."""
    @property
    def terminal(self) -> bool:
        """Whether the run ends there."""

@final
class Event:
    """An event function of `fn events` in the Rust block of the system, of as many as `EVENTS` says."""

    def __new__(cls, index: int = 0, *, direction: float = 0.0, terminal: bool = False) -> Self: ...
    @property
    def index(self) -> int:
        """Which of them."""
    @property
    def direction(self) -> float:
        """Which zeros count."""
    @property
    def terminal(self) -> bool:
        """Whether the run ends there."""

@final
class Symmetry:
    """What a generator does to L_d, to the force and to its momentum, over samples."""

    @property
    def generator(self) -> str:
        """The name of the generator."""
    @property
    def is_symmetry_of_lagrangian(self) -> bool:
        """Whether it is a symmetry of L_d."""
    @property
    def force_does_work(self) -> bool:
        """Whether the discrete force does work along it."""
    @property
    def is_conserved(self) -> bool:
        """Whether its momentum is conserved."""
    @property
    def is_consistent(self) -> bool:
        """Whether the momenta that the step uses are those of L_d and f_d, as they must be."""
    @property
    def lagrangian(self) -> tuple[float, float]:
        """The largest ξ(L_d), and what counts as zero there."""
    @property
    def force(self) -> tuple[float, float]:
        """The largest f_d(ξ), and what counts as zero there."""
    @property
    def defect(self) -> tuple[float, float]:
        """The largest sum of both, and what counts as zero there."""
    @property
    def text(self) -> str:
        """The report in words, which it prints."""

@final
class EnergyLedger:
    """Where the energy of a run went."""

    @property
    def change(self) -> float:
        """The energy at the end less that at the start."""
    @property
    def dissipated(self) -> float:
        """What friction took."""
    @property
    def work(self) -> float:
        """What the general force brought."""
    @property
    def remainder(self) -> float:
        """What the method did: change + dissipated − work."""
    @property
    def largest_remainder(self) -> float:
        """The largest remainder of one step, by size."""

@final
class Run:
    """The records of a run."""

    @property
    def t(self) -> _Array:
        """Times, shape (records,)."""
    @property
    def q(self) -> _Array:
        """Configurations, shape (records, n)."""
    @property
    def v(self) -> _Array:
        """Velocities, shape (records, n)."""
    @property
    def p(self) -> _Array:
        """Momenta, shape (records, n)."""
    @property
    def energy(self) -> _Array:
        """Energies v·∂L/∂v − L, shape (records,)."""
    @property
    def by_start(self) -> _Array | None:
        """∂(q, p)/∂(q0, p0), shape (records, 2n, 2n); None unless `derivatives=True`."""
    @property
    def by_parameters(self) -> _Array | None:
        """∂(q, p)/∂θ with (q0, p0) held, shape (records, 2n, parameters); None unless `derivatives=True`."""
    @property
    def reactions(self) -> _Array | None:
        """λ of the constraints over the step that led there, at the start over the first, shape (records, constraints); None
        unless `reactions=True`."""
    @property
    def steps(self) -> int:
        """Steps taken."""
    @property
    def iterations(self) -> int:
        """Iterations of the solver, all steps together."""
    @property
    def h(self) -> float:
        """The step size."""
    @property
    def rule(self) -> str:
        """The rule, or the method chosen for the tolerance."""
    @property
    def expected(self) -> float | None:
        """The error expected at the end of a run to a tolerance; None of others."""
    @property
    def breach(self) -> Breach | None:
        """Where the error expected has passed the tolerance; None where it has not."""
    @property
    def events(self) -> list[Crossings]:
        """The events of each function that was given."""
    def to_pandas(self) -> Any:
        """A pandas DataFrame with a row for each record and t as its index."""
    def to_xarray(self) -> Any:
        """An xarray Dataset with the coordinate t."""
    def plot(self) -> Any:
        """A figure of matplotlib: q above, the energy below."""
    def __len__(self) -> int: ...

@final
class Linearization:
    """A step and its derivatives."""

    @property
    def q(self) -> _Array:
        """Configuration at the end of the step, shape (n,)."""
    @property
    def p(self) -> _Array:
        """Momentum at the end of the step, shape (n,)."""
    @property
    def a(self) -> _Array:
        """A = ∂(q1, p1)/∂(q0, p0), shape (2n, 2n)."""
    @property
    def b(self) -> _Array | None:
        """B = ∂(q1, p1)/∂u, shape (2n, inputs); None where there is no input."""
    @property
    def by_parameters(self) -> _Array | None:
        """∂(q1, p1)/∂θ, shape (2n, parameters); None where the attribute lists none."""

@final
class Ends:
    """The states of all members, one row each."""

    @property
    def t(self) -> _Array:
        """Times, shape (members,), or (members, records)."""
    @property
    def q(self) -> _Array:
        """Configurations, shape (members, n), or (members, records, n)."""
    @property
    def v(self) -> _Array:
        """Velocities, of the shape of q."""
    @property
    def p(self) -> _Array:
        """Momenta, of the shape of q."""
    @property
    def energy(self) -> _Array:
        """Energies, of the shape of t."""
    @property
    def events(self) -> list[Crossings]:
        """The events of each function that was given, member by member."""
    @property
    def failures(self) -> dict[int, Exception]:
        """Why members are not what was asked for, by their numbers: exceptions that were not raised. Their rows are NaN."""
    def __len__(self) -> int: ...

@final
class Parts:
    """What was written as Parquet files, one for each part of the members."""

    @property
    def written(self) -> int:
        """Parts that were computed and written."""
    @property
    def found(self) -> int:
        """Parts that were there."""
    @property
    def failed(self) -> int:
        """Members that failed, of parts written and found."""
    @property
    def failed_before(self) -> int:
        """Members among them of parts that were there."""
    @property
    def spared(self) -> int:
        """Files of these parts that another call writes, or may be writing on another host, left alone."""
    @property
    def paths(self) -> list[Path]:
        """The files, in order."""
    def __len__(self) -> int: ...

class _Structure(TypedDict):
    engine: str
    constant_mass_matrix: bool
    quadratic_lagrangian: bool
    separable_lagrangian: bool
    fused_multiply_add: bool
    damping: str
    kinks: int
    cyclic: list[dict[str, int | bool]]
    newton_matrices: list[dict[str, str | bool | int]]

class StepError(ArithmeticError):
    """A step that could not be taken."""

    kind: str
    data: dict[str, Any]
    step: int | None
    t: float
    q: _Array | None
    p: _Array | None
    partial: dict[str, _Array] | None

class ToleranceError(ArithmeticError):
    """No method was chosen for the tolerance: the message says why."""

class EventError(ArithmeticError):
    """An event function that cannot be followed: the message says which and when."""

class BreachWarning(UserWarning):
    """The error expected has passed the tolerance: `run.breach` says where."""

@disjoint_base
class System:
    """A system with its fields: what all systems of this module have in common."""

    COORDINATES: ClassVar[int]
    INPUTS: ClassVar[int]
    TAKES_TIME: ClassVar[bool]
    CONSTRAINTS: ClassVar[int]
    EVENTS: ClassVar[int]
    PARAMETERS: ClassVar[tuple[str, ...]]
    RULES: ClassVar[tuple[str, ...]]
    STRUCTURE: ClassVar[_Structure]

    def run(
        self,
        *,
        q: _Numbers,
        v: _Numbers | None = None,
        p: _Numbers | None = None,
        h: float | None = None,
        steps: int | None = None,
        tolerance: float | None = None,
        until: float | None = None,
        times: Sequence[float] | _Array | None = None,
        every: int | None = None,
        max_steps: int | None = None,
        rule: str | None = None,
        u: _Numbers | None = None,
        t: float | None = None,
        derivatives: bool = False,
        reactions: bool = False,
        events: _Event | Sequence[_Event] | None = None,
        progress: Callable[[int, int], object] | None = None,
    ) -> Run:
        """The motion from (q, v), or from (q, p)."""
    @overload
    def ensemble(
        self,
        *,
        q: _Numbers,
        v: _Numbers | None = None,
        p: _Numbers | None = None,
        h: float | None = None,
        steps: int | None = None,
        tolerance: float | None = None,
        until: float | None = None,
        every: int | None = None,
        rule: str | None = None,
        u: _Numbers | None = None,
        t: float | None = None,
        fields: dict[str, Any] | None = None,
        events: _Event | Sequence[_Event] | None = None,
        folder: None = None,
        members_per_part: int | None = None,
        first: int | None = None,
        threads: int | None = None,
        progress: Callable[[int, int], object] | None = None,
    ) -> Ends: ...
    @overload
    def ensemble(
        self,
        *,
        q: _Numbers,
        v: _Numbers | None = None,
        p: _Numbers | None = None,
        h: float | None = None,
        steps: int | None = None,
        tolerance: float | None = None,
        until: float | None = None,
        every: int | None = None,
        rule: str | None = None,
        u: _Numbers | None = None,
        t: float | None = None,
        fields: dict[str, Any] | None = None,
        events: _Event | Sequence[_Event] | None = None,
        folder: str | PathLike[str],
        members_per_part: int | None = None,
        first: int | None = None,
        threads: int | None = None,
        progress: Callable[[int, int], object] | None = None,
    ) -> Parts:
        """Many members, each a system and a start of its own, on all cores."""
    def linearization(
        self,
        *,
        h: float,
        q: _Numbers,
        v: _Numbers | None = None,
        p: _Numbers | None = None,
        u: _Numbers | None = None,
        t: float | None = None,
        rule: str | None = None,
    ) -> Linearization:
        """A step from (q, v), or from (q, p), with its derivatives."""
    def symmetries(
        self,
        *,
        h: float,
        low: _Numbers,
        high: _Numbers,
        reach: _Numbers,
        samples: int | None = None,
        generators: dict[str, tuple[_Numbers, _Numbers]] | None = None,
        u: _Numbers | None = None,
        t: float | None = None,
        rule: str | None = None,
    ) -> list[Symmetry]:
        """What translations and rotations do to the discrete Lagrangian, to the force and to their momenta."""
    def energy_ledger(
        self,
        *,
        h: float,
        steps: int,
        q: _Numbers,
        v: _Numbers | None = None,
        p: _Numbers | None = None,
        u: _Numbers | None = None,
        t: float | None = None,
        rule: str | None = None,
    ) -> EnergyLedger:
        """Where the energy of a run went, by the rule's own account of what forces did."""
    def nearest(self, *, q: _Numbers, v: _Numbers, t: float | _Numbers | None = None) -> tuple[_Array, _Array]:
        """The configuration and velocity on all constraints that are nearest to (q, v), or those of as many as there are rows."""
    def energy(
        self,
        *,
        q: _Numbers,
        v: _Numbers | None = None,
        p: _Numbers | None = None,
        t: float | _Numbers | None = None,
    ) -> Any:
        """The energy v·∂L/∂v − L of a state, or of as many as there are rows."""

def stub() -> str:
    """The text of the module's .pyi."""
