"""Example 0: the least code that brakes a wheel.

    make demo                                        # the FMU, and Python with fmpy in .venv
    .venv/bin/python examples/ex00_minimal.py
"""

# 1. The solver is inside the FMU: any master can drive it, here fmpy's.
from fmpy import simulate_fmu

# 2. A parameter and an input; all others keep the values of the preset `railway`.
start = {"initial.velocity": 27.8, "brake.torque": 8000.0}

# 3. One second in steps of one millisecond; the columns of the result are the outputs that are asked for.
outputs = ["wheel.velocity", "contact.force_x", "contact.creepage", "temperature.wheel_max"]
result = simulate_fmu("target/wheelrail.fmu", stop_time=1.0, output_interval=1e-3, start_values=start, output=outputs)

# 4. SI units throughout: m/s, N, 1, K.
print(f"{'time':>10}" + "".join(f"{name:>24}" for name in outputs))
for row in result[::100]:
    print(f"{row['time']:10.2f}" + "".join(f"{row[name]:24.6g}" for name in outputs))
