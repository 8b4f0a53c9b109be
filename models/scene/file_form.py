"""Names of the forms of files that are no pictures, or none that is read, from their first bytes."""

import re
import zipfile
import zlib
from pathlib import Path

HEAD = 4096  # bytes that are looked at
# What numpy.load and zipfile raise for a damaged or encrypted file, an odd compression, and a header of impossible size
ARRAY_ERRORS = (
    OSError,
    ValueError,
    EOFError,
    KeyError,
    TypeError,
    SyntaxError,
    RuntimeError,
    OverflowError,
    MemoryError,
    zipfile.BadZipFile,
    zlib.error,
)
TO_PICTURE = "save it as PNG or TIFF"
TO_ARRAY = "save the array as .npy or .npz"
DEVELOP = "a raw photograph ({}): must be developed first, as TIFF or PNG of 16 bits"
DRAWING = "{}, a drawing: must be rendered to pixels, as PNG or TIFF"

VIDEO = rb"(?s:.{4}(ftyp(?!avi[fs])|moov|mdat|wide)|\x1aE\xdf\xa3|RIFF.{4}AVI |FLV|OggS|0&\xb2u|\0\0\x01\xba|G.{187}G)"

# First bytes, as a regular expression, and what the file is
FORMS = {
    rb"\Z": "empty: must be an image file",
    rb"version https://git-lfs": "a Git LFS pointer: must be the file itself; git lfs pull",
    rb"\s*(?i:<!doctype html|<html)": "a web page: must be an image file; download the file itself",
    rb"%!PS|\xc5\xd0\xd3\xc6": DRAWING.format("EPS or PostScript"),
    rb"%PDF": DRAWING.format("PDF"),
    rb"(?s:\s*(<\?xml.*)?<svg\W)": DRAWING.format("SVG"),
    rb"(?s:\xd7\xcd\xc6\x9a|\x01\0\0\0.{36} EMF)": DRAWING.format("WMF or EMF"),
    rb"MATLAB": f"a MATLAB file: must be an image, or an array; {TO_ARRAY} (scipy.io.loadmat, h5py)",
    rb"\x89HDF\r\n": f"an HDF5 file: must be an image, or an array; {TO_ARRAY} (h5py)",
    rb"\x93NUMPY": "a NumPy array: must end in .npy",
    rb"CDF[\x01\x02]": f"a NetCDF file: must be an image, or an array; {TO_ARRAY}",
    rb"SIMPLE  =": f"a FITS file: must be an image, or an array; {TO_ARRAY} (astropy.io.fits)",
    rb"(?s:.{128}DICM)": f"a DICOM file: must be an image, or an array; {TO_ARRAY} (pydicom)",
    rb"(?s:.{344}(n\+1|ni1)\0)": f"a NIfTI file: must be an image, or an array; {TO_ARRAY} (nibabel)",
    rb"\x76\x2f\x31\x01": "OpenEXR: must be floating-point TIFF (linear, 0..1), or an array as .npy",
    rb"#\?(RADIANCE|RGBE)": "Radiance HDR: must be floating-point TIFF (linear, 0..1), or an array as .npy",
    rb"(?s:.{4}ftyp(hei|hev|mif|msf))": f"HEIC: must be another form; {TO_PICTURE}",
    rb"\xff\x0a|\0\0\0\x0cJXL ": f"JPEG XL: must be another form; {TO_PICTURE}",
    rb"II\xbc\x01": f"JPEG XR: must be another form; {TO_PICTURE}",
    rb"8BPS": f"a Photoshop file: must be another form; {TO_PICTURE}",
    rb"gimp xcf": f"a GIMP file: must be another form; {TO_PICTURE}",
    rb"(?s:.{4}ftypcrx)": DEVELOP.format("CR3"),
    rb"(?s:(II\*|MM\0).{5}CR)": DEVELOP.format("CR2"),
    rb"FUJIFILM": DEVELOP.format("RAF"),
    rb"II(RO|RS)|MMOR": DEVELOP.format("ORF"),
    rb"IIU\0": DEVELOP.format("RW2"),
    rb"FOVb": DEVELOP.format("X3F"),
    rb"\0MRM": DEVELOP.format("MRW"),
    rb"\x89LF[PM]\r\n": "a Lytro light field: must be decoded to views, or an ESLF image",
    VIDEO: "a video or sound: must be one picture; talbot sequence takes videos",
    rb"ID3|(?s:RIFF.{4}WAVE)|fLaC": "sound: must be a picture",
    rb"PK\x03\x04|\x1f\x8b|BZh|\xfd7zXZ|7z\xbc\xaf|Rar!": "an archive: must be unpacked first",
}


def is_video(path: Path) -> bool:
    """Return whether a file begins as a container of videos does.

    path: the file. Returns bool: by its first bytes; HEIC is none. Raises OSError if it cannot be read.
    """
    with path.open("rb") as file:
        head = file.read(HEAD)
    return next((magic for magic in FORMS if re.match(magic, head)), None) == VIDEO


def form_of(path: Path) -> str | None:
    """Return the form of a file that is no picture, and the required form.

    path: the file. Returns str or None: for a message, ``an HDF5 file: must be ...``; None where its first bytes tell
    nothing. Raises OSError if it cannot be read.
    """
    with path.open("rb") as file:
        head = file.read(HEAD)
    if head.startswith(b"\xff\xd8"):
        frame = re.search(rb"(?s)\xff([\xc0-\xc3\xc5-\xc7\xc9-\xcb\xcd-\xcf])..(.)", head)
        if frame and frame[2] != b"\x08":
            return f"JPEG of {frame[2][0]} bits: must have 8; {TO_PICTURE}"
        if frame and frame[1] not in b"\xc0\xc1\xc2":
            return f"lossless or arithmetic-coded JPEG: must be baseline or progressive; {TO_PICTURE}"
    return next((form for magic, form in FORMS.items() if re.match(magic, head)), None)
