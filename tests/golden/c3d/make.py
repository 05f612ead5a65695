"""The files of this folder: see README.md."""
import pathlib
import sys

here = pathlib.Path(__file__).parent
sys.path.insert(0, str(here / "../../support/netft"))
import c3d_writer  # noqa: E402

# Four frames of two markers at 50 Hz, mm; the second is not seen in the third frame.
frames = [[(10 * k + 1.5, -20.25 - k, 300.0 + 2 * k), (0.5, 1000.0 - k, -0.75)] for k in range(4)]
frames[2][1] = None
# Three samples a frame of a wrench, N and N mm.
analog = [[n + 0.5, -2 * n, 10.0, 100.0 * n, -50.0, 0.25 * n] for n in range(12)]
for processor in ("intel", "dec", "mips"):
    for name, scale, analog_scale, offset in (("real", -1.0, 1.0, 0), ("integer", 0.25, 0.25, 5)):
        c3d_writer.write(here / f"{processor}_{name}.c3d", frames, ["tip", "top"], 50.0, analog,
                         ["Fx", "Fy", "Fz", "Mx", "My", "Mz"], ["N", "N", "N", "Nmm", "Nmm", "Nmm"], 3, processor, scale,
                         "mm", analog_scale, offset)
