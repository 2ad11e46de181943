"""What a run shows of itself, and the forms of other packages in which it hands over its records."""

import importlib

VECTORS = ("q", "v", "p")


def needed(name):
    """The module of this name, which dalembert does not depend on."""
    package = name.partition(".")[0]
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError as error:
        if error.name != package:
            raise
        raise ImportError(f"{package} is not installed; pip install {package}") from error


def shown(run):
    expected = "" if run.expected is None else f", error expected {run.expected:.1e}"
    steps = "step" if run.steps == 1 else "steps"
    lines = [f"Run: {run.steps} {steps} of {run.h!r} by {run.rule}, {run.iterations} iterations{expected}"]
    lines.append(f"  q, v, p        {run.q.shape}")
    for name in ("t", "energy"):
        array = getattr(run, name)
        ends = f"  {array[0]:.6g} to {array[-1]:.6g}" if array.size else ""
        lines.append(f"  {name:<13}  {array.shape}{ends}")
    for name in ("by_start", "by_parameters", "reactions"):
        array = getattr(run, name)
        if array is not None:
            lines.append(f"  {name:<13}  {array.shape}")
    if run.events:
        lines.append(f"  events         {[len(found) for found in run.events]}")
    if run.breach is not None:
        lines.append(f"  breach         at t = {run.breach.t:.6g}, error expected {run.breach.expected:.1e}")
    return "\n".join(lines)


def to_pandas(run):
    columns = {f"{name}{i}": getattr(run, name)[:, i] for name in VECTORS for i in range(run.q.shape[1])}
    columns["energy"] = run.energy
    if run.reactions is not None:
        columns |= {f"reaction{i}": column for i, column in enumerate(run.reactions.T)}
    pandas = needed("pandas")
    return pandas.DataFrame(columns, index=pandas.Index(run.t, name="t"))


def to_xarray(run):
    dimensions = {name: ("t", "coordinate") for name in VECTORS} | {
        "energy": ("t",),
        "by_start": ("t", "state", "start"),
        "by_parameters": ("t", "state", "parameter"),
        "reactions": ("t", "constraint"),
    }
    arrays = {name: (of, getattr(run, name)) for name, of in dimensions.items() if getattr(run, name) is not None}
    attributes = {"rule": run.rule, "h": run.h, "steps": run.steps}
    return needed("xarray").Dataset(arrays, coords={"t": run.t}, attrs=attributes)


def plot(run):
    figure, (above, below) = needed("matplotlib.pyplot").subplots(2, 1, sharex=True, layout="constrained")
    above.plot(run.t, run.q, label=[f"q{i}" for i in range(run.q.shape[1])])
    above.set_ylabel("q")
    above.legend()
    below.plot(run.t, run.energy)
    below.set(xlabel="t", ylabel="energy")
    return figure
