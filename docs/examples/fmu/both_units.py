"""Both units in a loop by FMPy: the exit speed of one pass."""

from fmpy import extract, read_model_description
from fmpy.fmi3 import FMU3Slave


def loaded(file):
    described = read_model_description(file)
    unit = FMU3Slave(
        guid=described.instantiationToken,
        unzipDirectory=extract(file),
        modelIdentifier=described.coSimulation.modelIdentifier,
        instanceName="one",
    )
    unit.instantiate()
    return unit, {each.name: each.valueReference for each in described.modelVariables}


controller, here = loaded("fmu/retarder_controller.fmu")
position, there = loaded("fmu/retarder_position.fmu")
position.setFloat64([there["friction_factor"], there["entry_speed_m_s"]], [0.9, 3.8])
for unit in (controller, position):
    unit.enterInitializationMode(startTime=0.0)
    unit.exitInitializationMode()
wires = ["path_m", "measured_m_s", "mean_overpressure_kpa", "pressure_kpa"]
time_s, step_s = 0.0, 0.1
while position.getInt32([there["end"]]) == [0]:
    controller.setFloat64([here[name] for name in wires], position.getFloat64([there[name] for name in wires]))
    controller.setBoolean([here["at_rest"]], position.getBoolean([there["at_rest"]]))
    controller.doStep(time_s, step_s)
    position.setInt32([there["stage"]], controller.getInt32([here["stage"]]))
    position.doStep(time_s, step_s)
    time_s += step_s
print(position.getFloat64([there["exit_speed_m_s"]]))
