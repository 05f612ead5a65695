"""Simulated CT series as DICOM files (PS3.10, Explicit VR Little Endian), with a patient planted in them."""
import struct

CT_STORAGE, EXPLICIT_LITTLE = "1.2.840.10008.5.1.4.1.1.2", "1.2.840.10008.1.2.1"
PATIENT = {"name": "Mustermann^Erika", "id": "PID-4711-0815", "birth": "19470823", "hospital": "Sanatorium Waldfrieden"}
STUDY_UID = "2.25.271828182845904"


def element(tag, vr, value):
    if isinstance(value, str):
        value = value.encode()
    if len(value) % 2:
        value += b"\0" if vr == "UI" else b" "
    head = struct.pack("<HH", tag >> 16, tag & 0xFFFF) + vr.encode()
    if vr in ("OB", "OW"):
        return head + b"\0\0" + struct.pack("<I", len(value)) + value
    return head + struct.pack("<H", len(value)) + value


def number(tag, value):
    return element(tag, "US", struct.pack("<H", value))


def pixels(side, k):
    """A ramp: CT value 10 i + j + k, no two slices alike."""
    return b"".join(struct.pack("<h", 10 * i + j + k) for j in range(side) for i in range(side))


def slice_file(series_uid, k, *, side, spacing_mm, thickness_mm, description, number_of_series, study=STUDY_UID, date="20240314",
               study_description="CT lumbar spine", patient=PATIENT):
    """Slice `k` of a series as the bytes of a file."""
    instance = f"{series_uid}.{k + 1}"
    meta = (element(0x00020001, "OB", b"\0\1") + element(0x00020002, "UI", CT_STORAGE) + element(0x00020003, "UI", instance) +
            element(0x00020010, "UI", EXPLICIT_LITTLE) + element(0x00020012, "UI", "2.25.1"))
    data = b"".join([
        element(0x00080016, "UI", CT_STORAGE), element(0x00080018, "UI", instance), element(0x00080020, "DA", date),
        element(0x00080050, "SH", "ACC-99-1234"), element(0x00080060, "CS", "CT"), element(0x00080080, "LO", patient["hospital"]),
        element(0x00081030, "LO", study_description), element(0x0008103E, "LO", description),
        element(0x00100010, "PN", patient["name"]), element(0x00100020, "LO", patient["id"]), element(0x00100030, "DA", patient["birth"]),
        element(0x00180050, "DS", f"{thickness_mm:g}"), element(0x0020000D, "UI", study), element(0x0020000E, "UI", series_uid),
        element(0x00200011, "IS", str(number_of_series)), element(0x00200013, "IS", str(k + 1)),
        element(0x00200032, "DS", f"-10\\20\\{100 + k * thickness_mm:g}"), element(0x00200037, "DS", "1\\0\\0\\0\\1\\0"),
        element(0x00200052, "UI", "2.25.161803398874989"),
        number(0x00280002, 1), element(0x00280004, "CS", "MONOCHROME2"), number(0x00280010, side), number(0x00280011, side),
        element(0x00280030, "DS", f"{spacing_mm:g}\\{spacing_mm:g}"), number(0x00280100, 16), number(0x00280101, 16), number(0x00280102, 15),
        number(0x00280103, 1), element(0x00281052, "DS", "0"), element(0x00281053, "DS", "1"),
        element(0x7FE00010, "OW", pixels(side, k))])
    return b"\0" * 128 + b"DICM" + element(0x00020000, "UL", struct.pack("<I", len(meta))) + meta + data


def series(series_uid, slices, **facts):
    return [slice_file(series_uid, k, **facts) for k in range(slices)]
