"""The rooms that are mutated: their sources, and the test programs that hold them. docs/architecture.md draws the rooms."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Room:
    folder: str
    programs: tuple[str, ...]
    without: tuple[str, ...] = ()  # folders and files that only other tests see


ROOMS = [
    Room("models/mechanisms", ("kerf_mechanisms_test",)),
    Room("models", ("kerf_models_test", "kerf_lattice_test"), ("models/benchmarks", "models/mechanisms")),
    Room("compare", ("kerf_compare_test",)),
    Room("fitting/psychophysics", ("kerf_psychophysics_test",), ("fitting/psychophysics/benchmarks",)),
    Room("fitting/population", ("kerf_population_test",), ("fitting/population/benchmarks",)),
    Room("fitting", ("kerf_fitting_test", "kerf_events_test"), ("fitting/benchmarks", "fitting/population", "fitting/psychophysics")),
    Room("bench/data", ("kerf_data_test",)),
    Room("bench/runtime", ("kerf_runtime_test",),
         ("bench/runtime/record/push_benchmark.cpp", "bench/runtime/loop/blame_benchmark.cpp")),
    Room("datasets-schema", ("schema_test", "power_cut_test")),
    # What speaks to hardware is held by tests/usb, in a guest.
    Room("drivers", ("kerf_drivers_test",),
         ("drivers/emulators", "drivers/guard", "drivers/src/usb", "drivers/src/falcon", "drivers/src/woodenhaptics",
          "drivers/src/spacemouse.cpp", "drivers/src/force/force_sensor_u6.cpp", "drivers/src/open_device.cpp",
          "drivers/include/kerf/drivers/usb", *(f"drivers/include/kerf/drivers/{name}.h" for name in
                                                ("falcon", "woodenhaptics", "spacemouse", "force_sensor_u6")))),
]  # fmt: skip


def lies_in(file: str, folder: str) -> bool:
    return file == folder or file.startswith(folder.rstrip("/") + "/")


def room_of(file: str) -> Room | None:
    for room in ROOMS:
        if lies_in(file, room.folder):
            return None if any(lies_in(file, other) for other in room.without) else room
    return None
