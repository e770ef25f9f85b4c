"""What a record was made from: version, preset, and the parameters that differ from it."""

import json
from pathlib import Path


def settings(wheel):
    """Version, preset and the parameters that differ from it, choices by name."""
    fmu = wheel.fmu
    parameters = [v for v in fmu.variables.values() if v.causality == "parameter"]
    values = {v.name: wheel.get(v.name) for v in parameters}
    preset = values.pop("preset", "")
    base = preset_values(fmu, preset)
    # The package itself writes the first of these, so that everything counts that is written.
    base["initial.given"] = "written"
    named = {v.name: _choice(v, values[v.name]) for v in parameters if v.name in values}
    differ = {name: value for name, value in named.items() if value != base.get(name)}
    return {"fmu_version": fmu.description.version or "", "preset": preset, "parameters": differ}


def _choice(variable, value):
    """The name of a choice; any other value itself."""
    return variable.declaredType.items[int(value) - 1].name if variable.type == "Enumeration" else value


def _start(variable):
    """The start value of a parameter, which the description has as text."""
    text = variable.start
    if text is None or variable.type == "String":
        return text
    if variable.type == "Boolean":
        return text == "true"
    return float(text) if variable.type == "Real" else _choice(variable, text) if variable.type == "Enumeration" else int(text)


def preset_values(fmu, preset):
    """Parameters of a preset by name, choices by theirs: start values, and what it sets besides."""
    path = Path(fmu.directory, "resources", f"{preset}.json")
    groups = json.loads(path.read_text()) if path.is_file() else {}
    start = {v.name: _start(v) for v in fmu.variables.values() if v.causality == "parameter" and v.name != "preset"}
    return start | {f"{group}.{name}": value for group, values in groups.items() for name, value in values.items()}
