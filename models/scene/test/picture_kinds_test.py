"""Pictures of every kind: the values that the file means, or one line that names its kind."""

import struct
import zlib
from itertools import product

import numpy as np
import pytest
import tifffile
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

from talbot.models.parameters import ParameterError
from talbot.models.scene import Sampling, load, open_clip, tiff_file
from talbot.models.scene.picture_file import decode16, header_of, read_codes, read_luminance, read_picture
from talbot.models.scene.test.focused import focused

SHAPE = 10, 14
Y, X = np.mgrid[: SHAPE[0], : SHAPE[1]]
UNIT = (X + 3 * Y + 1) / 48  # differs wherever it is turned
REC709 = np.array([0.2126, 0.7152, 0.0722])


def luminance(path):
    return read_luminance(path, *SHAPE)


def codes(bits, unit=UNIT):
    return np.rint(unit * ((1 << bits) - 1)).astype(np.uint8 if bits <= 8 else np.uint16)


def colours(bits=16):
    return np.stack([codes(bits), codes(bits, 1 - UNIT), codes(bits, UNIT**2)], 2)


def light(values, white):
    linear = decode16(values / white)
    return linear @ REC709 if linear.ndim == 3 else linear


def png(path, bits, kind, data, *chunks):
    """A PNG of any kind; data: bytes of rows, each of whole bytes."""
    height, width = SHAPE

    def chunk(name, body):
        return struct.pack(">I", len(body)) + name + body + struct.pack(">I", zlib.crc32(name + body))

    rows = b"".join(b"\0" + row.tobytes() for row in data)
    path.write_bytes(
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, bits, kind, 0, 0, 0))
        + b"".join(chunk(name, body) for name, body in chunks)
        + chunk(b"IDAT", zlib.compress(rows))
        + chunk(b"IEND", b"")
    )
    return path


def packed(values, bits):
    """Rows of samples of 1 to 16 bits, (height, samples), as bytes."""
    split = (values[..., None].astype(int) >> np.arange(bits - 1, -1, -1)) & 1
    return np.packbits(split.reshape(len(values), -1).astype(np.uint8), axis=1)


@pytest.mark.parametrize("clear", [False, True])
@pytest.mark.parametrize("bits", [1, 2, 4, 8, 16])
def test_gray_png_of_every_depth_with_a_transparent_code(tmp_path, bits, clear):
    values = codes(bits)
    chosen = int(values[3, 4])
    path = png(tmp_path / "p.png", bits, 0, packed(values, bits), *[(b"tRNS", struct.pack(">H", chosen))] * clear)
    want = light(values, (1 << bits) - 1)
    if clear:
        want[values == chosen] = 1
    np.testing.assert_allclose(luminance(path), want, atol=1e-6)


@pytest.mark.parametrize("bits", [1, 2, 4, 8])
@pytest.mark.parametrize("clear", [b"", b"\0", b"\xff\x80"])
def test_palette_png(tmp_path, bits, clear):
    values = codes(bits)
    table = np.random.default_rng(bits).integers(0, 256, (1 << bits, 3), np.uint8)
    chunks = [(b"PLTE", table.tobytes()), *[(b"tRNS", clear)] * bool(clear)]
    path = png(tmp_path / "p.png", bits, 3, packed(values, bits), *chunks)
    alpha = np.full(1 << bits, 255)
    alpha[: len(clear)] = list(clear)
    shown = table * (alpha / 255)[:, None] + 255 - alpha[:, None]
    np.testing.assert_allclose(luminance(path), light(np.rint(shown)[values], 255), atol=0.006)


@pytest.mark.parametrize("bits", [8, 16])
@pytest.mark.parametrize("clear", [False, True])
def test_colour_png_keeps_its_depth(tmp_path, bits, clear):
    values = colours(bits)
    chosen = values[2, 5]
    chunks = [(b"tRNS", chosen.astype(">u2").tobytes())] * clear
    path = png(tmp_path / "p.png", bits, 2, packed(values.reshape(SHAPE[0], -1), bits), *chunks)
    want = light(values, (1 << bits) - 1)
    if clear:
        want[(values == chosen).all(2)] = 1
    np.testing.assert_allclose(luminance(path), want, atol=1e-6)
    dark = np.full((*SHAPE, 3), 180, np.uint16)  # below the lowest code of 8 bits
    np.testing.assert_allclose(
        luminance(png(tmp_path / "dark.png", 16, 2, packed(dark.reshape(SHAPE[0], -1), 16))), 180 / 65535 / 12.92, 1e-3
    )


@pytest.mark.parametrize("bits", [8, 16])
@pytest.mark.parametrize("kind", [4, 6])
def test_png_with_alpha(tmp_path, bits, kind):
    top = (1 << bits) - 1
    values, alpha = codes(bits)[..., None] if kind == 4 else colours(bits), codes(bits, 1 - UNIT)[..., None]
    data = np.concatenate([values, alpha], 2)
    path = png(tmp_path / "p.png", bits, kind, packed(data.reshape(SHAPE[0], -1), bits))
    shown = (values * (alpha / top) + top - alpha)[..., 0 if kind == 4 else slice(None)]
    np.testing.assert_allclose(luminance(path), light(shown, top), atol=0.006 if bits == 8 else 3e-5)


@pytest.mark.parametrize("orientation", range(1, 9))
@pytest.mark.parametrize(
    "name", ["p.jpg", "p.png", "p.webp", "p.tif", "lzw.tif", "deep.tif", "gray.tif", "gray16.tif", "gray16.png"]
)
def test_every_orientation(tmp_path, name, orientation):
    """A photograph is shown as the camera was held, and so is its depth map."""
    stored = np.rint(UNIT * 200 + 20).astype(np.uint8)
    if name not in ("gray.tif", "gray16.tif", "gray16.png"):
        stored = np.repeat(stored[..., None], 3, 2)
    if "16" in name or "deep" in name:
        stored = stored.astype(np.uint16) * 257
    path = tmp_path / name
    if path.suffix == ".tif":
        options = {"compression": "lzw"} if name == "lzw.tif" else {}
        tifffile.imwrite(path, stored, extratags=[(274, 3, 1, orientation, False)], metadata=None, **options)
    else:
        exif = Image.Exif()
        exif[274] = orientation
        Image.fromarray(stored).save(path, exif=exif, **{"quality": 100, "subsampling": 0} if name == "p.jpg" else {})
    gray = stored[..., 0] if stored.ndim == 3 else stored
    turned = {1: 0, 2: "flip", 3: 2, 4: "flop", 5: "T", 6: 3, 7: "anti", 8: 1}[orientation]
    flips = {"flip": gray[:, ::-1], "flop": gray[::-1], "T": gray.T, "anti": gray[::-1, ::-1].T}
    want = flips[turned] if isinstance(turned, str) else np.rot90(gray, turned)
    assert header_of(path, "scene").shape == want.shape
    np.testing.assert_allclose(luminance(path), light(want, 65535 if gray.dtype == np.uint16 else 255), atol=0.03)
    if path.suffix != ".jpg":
        got = read_codes(path, "depth")
        np.testing.assert_allclose(got, want, atol=6 if path.suffix == ".webp" else 0)


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("photometric", ["minisblack", "miniswhite"])
@pytest.mark.parametrize(
    "dtype, compression",
    [
        *product(["bool", "uint8", "uint16", "int16", "float16", "float32", "float64"], [None, "zlib"]),
        *product(["bool", "uint8", "uint16"], ["lzw"]),  # of other types imagecodecs alone writes it
    ],
)
def test_gray_tiff(tmp_path, monkeypatch, order, photometric, dtype, compression):
    unit = np.round(UNIT) if dtype == "bool" else UNIT
    kind = np.dtype(dtype)
    white = 1 if kind.kind in "fb" else np.iinfo(kind).max
    values = (unit * white).astype(kind) if kind.kind != "b" else unit > 0.5
    shown = np.asarray(white - values.astype(float) if photometric == "miniswhite" else values, float)
    want = shown if kind.kind == "f" else light(shown, white)
    path = tmp_path / "p.tif"
    tifffile.imwrite(path, values, photometric=photometric, compression=compression, byteorder=order)
    np.testing.assert_allclose(luminance(path), want, atol=1e-3 if kind == np.float16 else 1e-6)
    without_imagecodecs(monkeypatch)
    if (compression, order, photometric, dtype) == ("lzw", ">", "miniswhite", "uint16"):
        with pytest.raises(ParameterError, match="16 bits compressed as LZW: needs the package imagecodecs"):
            luminance(path)
    else:
        np.testing.assert_allclose(luminance(path), want, atol=1e-3 if kind == np.float16 else 1e-6)


def without_imagecodecs(monkeypatch):
    """As where only run.lock is installed."""
    decode = tifffile.TiffPage.asarray

    def asarray(page, *rest, **options):
        if page.compression in (5, 34925) or page.predictor == 3:
            raise ValueError("<COMPRESSION.LZW: 5> requires the 'imagecodecs' package")
        return decode(page, *rest, **options)

    monkeypatch.setattr(tifffile.TiffPage, "asarray", asarray)


@settings(max_examples=40, deadline=None)
@given(
    bits=st.integers(1, 16),
    samples=st.sampled_from([1, 3]),
    order=st.sampled_from(["<", ">"]),
    strips=st.integers(1, SHAPE[0]),
    inverted=st.booleans(),
)
def test_tiff_of_any_number_of_bits(tmp_path_factory, bits, samples, order, strips, inverted):
    """Packed samples, as cameras of 10, 12 and 14 bits write them: white is the largest code of these bits."""
    path = tmp_path_factory.mktemp("bits") / "p.tif"
    top = (1 << bits) - 1
    values = colours(bits) if samples == 3 else codes(bits)[..., None]
    rows = packed(values.reshape(SHAPE[0], -1), bits)
    if bits == 16 and order == "<":
        rows = rows.reshape(SHAPE[0], -1, 2)[..., ::-1].reshape(SHAPE[0], -1)
    blocks = [rows[i : i + strips].tobytes() for i in range(0, SHAPE[0], strips)]
    write_tiff(path, order, bits, samples, strips, blocks, photometric=2 if samples == 3 else int(not inverted))
    if samples == 1:
        values = top - values[..., 0] if inverted else values[..., 0]
    np.testing.assert_allclose(luminance(path), light(values, top), atol=1e-6)


def write_tiff(path, order, bits, samples, strips, blocks, photometric):
    """A TIFF of one page, uncompressed."""
    tags, data = [], b""
    end = 8

    def later(body):
        nonlocal data
        place = end + len(data)
        data += body + b"\0" * (len(body) % 2)
        return place

    offsets = [later(block) for block in blocks]
    for tag, kind, values in (
        (256, 4, [SHAPE[1]]),
        (257, 4, [SHAPE[0]]),
        (258, 3, [bits] * samples),
        (259, 3, [1]),
        (262, 3, [photometric]),
        (273, 4, offsets),
        (277, 3, [samples]),
        (278, 4, [strips]),
        (279, 4, [len(block) for block in blocks]),
    ):
        body = struct.pack(f"{order}{len(values)}{'H' if kind == 3 else 'I'}", *values)
        tags.append((tag, kind, len(values), body if len(body) <= 4 else struct.pack(order + "I", later(body))))
    head = b"II*\0" if order == "<" else b"MM\0*"
    directory = b"".join(struct.pack(order + "HHI", *tag[:3]) + tag[3].ljust(4, b"\0") for tag in tags)
    path.write_bytes(
        head
        + struct.pack(order + "I", end + len(data))
        + data
        + struct.pack(order + "H", len(tags))
        + directory
        + b"\0" * 4
    )


@pytest.mark.parametrize("planar", ["contig", "separate"])
@pytest.mark.parametrize("dtype", ["uint8", "uint16", "float32"])
@pytest.mark.parametrize(
    "options", [{}, {"bigtiff": True}, {"byteorder": ">"}, {"tile": (16, 16)}, {"rowsperstrip": 3}]
)
def test_colour_tiff(tmp_path, planar, dtype, options):
    kind = np.dtype(dtype)
    unit = np.stack([UNIT, 1 - UNIT, UNIT**2], 2)
    white = 1 if kind.kind == "f" else np.iinfo(kind).max
    values = (unit * white).astype(kind)
    stored = np.moveaxis(values, 2, 0) if planar == "separate" else values
    path = tmp_path / "p.tif"
    tifffile.imwrite(path, stored, photometric="rgb", planarconfig=planar, **options)
    want = values @ REC709 if kind.kind == "f" else light(values, white)
    np.testing.assert_allclose(luminance(path), want, atol=1e-6)
    np.testing.assert_array_equal(read_picture(path), values)  # a view of a light field


@pytest.mark.parametrize("samples", [3, 4])
def test_deep_colours_compressed_by_lzw(tmp_path, monkeypatch, samples):
    """As Photoshop writes them; without imagecodecs by Pillow's libtiff, twice."""
    values = np.concatenate([colours(16), codes(16, 1 - UNIT)[..., None]], 2)[..., :samples]
    path = tmp_path / "p.tif"
    extra = {"extrasamples": ["unassalpha"]} if samples == 4 else {}
    tifffile.imwrite(path, values, photometric="rgb", compression="lzw", predictor=True, **extra)
    alpha = values[..., 3:] / 65535 if samples == 4 else 1.0
    want = light(values[..., :3] * alpha + 65535 * (1 - alpha), 65535)
    np.testing.assert_allclose(luminance(path), want, atol=3e-5)
    without_imagecodecs(monkeypatch)
    np.testing.assert_allclose(luminance(path), want, atol=3e-5)


@pytest.mark.parametrize("dtype", ["uint8", "uint16", "float32"])
@pytest.mark.parametrize("associated", [False, True])
@pytest.mark.parametrize("colour", [False, True])
def test_tiff_with_alpha(tmp_path, dtype, associated, colour):
    kind = np.dtype(dtype)
    white = 1 if kind.kind == "f" else np.iinfo(kind).max
    unit, alpha = np.stack([UNIT, 1 - UNIT, UNIT**2], 2) if colour else UNIT[..., None], (1 - UNIT)[..., None]
    stored = np.concatenate([unit * alpha if associated else unit, alpha], 2) * white
    path = tmp_path / "p.tif"
    tifffile.imwrite(
        path,
        (stored if kind.kind == "f" else np.rint(stored)).astype(kind),
        photometric="rgb" if colour else "minisblack",
        planarconfig="contig",
        extrasamples=["assocalpha" if associated else "unassalpha"],
    )
    shown = unit * alpha + 1 - alpha
    shown = shown if colour else shown[..., 0]
    want = light(shown, 1) if kind.kind != "f" else shown @ REC709 if colour else shown
    np.testing.assert_allclose(luminance(path), want, atol=0.01 if white == 255 else 3e-5)


def test_palette_and_cmyk_tiff(tmp_path):
    table = np.random.default_rng(0).integers(0, 65536, (3, 256)).astype(np.uint16)
    tifffile.imwrite(tmp_path / "p.tif", codes(8), photometric="palette", colormap=table)
    np.testing.assert_allclose(luminance(tmp_path / "p.tif"), light(table.T[codes(8)], 65535), atol=1e-6)
    for dtype in (np.uint8, np.uint16):
        top = np.iinfo(dtype).max
        inks = np.stack([UNIT, 1 - UNIT, UNIT**2, UNIT / 2], 2)
        tifffile.imwrite(tmp_path / "c.tif", np.rint(inks * top).astype(dtype), photometric="separated")
        want = light((1 - inks[..., :3]) * (1 - inks[..., 3:]), 1)
        np.testing.assert_allclose(luminance(tmp_path / "c.tif"), want, atol=0.006)


def test_the_inks_of_a_jpeg_by_adobe_are_inverted(tmp_path):
    path = tmp_path / "p.jpg"
    Image.fromarray(colours(8)).convert("CMYK").save(path, quality=100)
    want = light(colours(8), 255)
    np.testing.assert_allclose(luminance(path).mean(), want.mean(), atol=0.05)


@pytest.mark.parametrize("plain", [False, True])
@pytest.mark.parametrize("top", [1023, 65535])
def test_deep_colour_ppm(tmp_path, top, plain):
    values = np.rint(np.stack([UNIT, 1 - UNIT, UNIT**2], 2) * top).astype(np.uint16)
    head = f"P{3 if plain else 6}\n{SHAPE[1]} {SHAPE[0]}\n{top}\n".encode()
    body = " ".join(map(str, values.ravel())).encode() if plain else values.astype(">u2").tobytes()
    (tmp_path / "p.ppm").write_bytes(head + body)
    np.testing.assert_allclose(luminance(tmp_path / "p.ppm"), light(values, top), atol=1e-6)


def test_thumbnails_are_no_pages(tmp_path):
    """A thumbnail before the picture, and one in a SubIFD."""
    path, values = tmp_path / "p.tif", codes(8)
    with tifffile.TiffWriter(path) as tiff:
        tiff.write(np.zeros((3, 4), np.uint8), subfiletype=1, metadata=None)
        tiff.write(values, subifds=1, metadata=None)
        tiff.write(np.zeros((3, 4), np.uint8), subfiletype=1, metadata=None)
    np.testing.assert_allclose(luminance(path), light(values, 255), atol=1e-6)


def test_a_stack_is_a_sequence(tmp_path):
    path, pages = tmp_path / "p.tif", [codes(8), codes(8, 1 - UNIT), codes(8, UNIT**2)]
    tifffile.imwrite(path, np.stack(pages), photometric="minisblack")
    with pytest.raises(ParameterError, match="is a TIFF stack of 3 pages: must be one picture; talbot sequence takes"):
        luminance(path)
    frames = list(open_clip(path, Sampling(*SHAPE)))
    for frame, page in zip(frames, pages, strict=True):
        assert frame.seconds == pytest.approx(1 / 30)
        np.testing.assert_allclose(frame.luminance, light(page, 255), atol=1e-6)


def cfa(path):
    tifffile.imwrite(path, codes(16), photometric=32803, extratags=[(33422, 1, 4, b"\0\1\1\2", False)])


def dng(path):
    """As a phone's: the first page is a thumbnail, the colour filter array in a SubIFD."""
    with tifffile.TiffWriter(path) as tiff:
        version = [(50706, 1, 4, b"\1\4\0\0", False)]
        tiff.write(colours(8), photometric="rgb", subfiletype=1, subifds=1, extratags=version, metadata=None)
        tiff.write(codes(16), photometric=32803, metadata=None)


@pytest.mark.parametrize(
    "name, write, said",
    [
        ("p.dng", dng, r"raw photograph \(DNG\): must be developed first"),
        ("p.nef", cfa, r"raw photograph \(NEF\): must be developed first"),
        ("p.cr2", b"II*\0\x10\0\0\0CR\2\0" + b"\0" * 50, "raw photograph .CR2.: must be developed"),
        ("p.cr3", b"\0\0\0\x18ftypcrx ", "raw photograph .CR3.: must be developed"),
        ("p.raf", b"FUJIFILMCCD-RAW 0201", "raw photograph .RAF.: must be developed"),
        ("p.heic", b"\0\0\0\x18ftypheic\0\0\0\0mif1", "HEIC: must be another form; save it as PNG or TIFF"),
        ("p.eps", b"%!PS-Adobe-3.0 EPSF-3.0\n", "EPS or PostScript, a drawing: must be rendered"),
        ("p.pdf", b"%PDF-1.7\n", "PDF, a drawing: must be rendered"),
        ("p.svg", b'<?xml version="1.0"?>\n<svg xmlns="x">', "SVG, a drawing: must be rendered"),
        ("p.h5", b"\x89HDF\r\n\x1a\n" + b"\0" * 90, "HDF5 file: .*must be an image, or an array; .*\\.npy or \\.npz"),
        ("p.mat", b"MATLAB 5.0 MAT-file, Platform: GLNXA64", "MATLAB file: must be .*scipy.io.loadmat"),
        ("p.exr", b"\x76\x2f\x31\x01\2\0\0\0", "OpenEXR: must be floating-point TIFF"),
        ("p.jxl", b"\xff\x0a\xfa\x7f", "JPEG XL: must be another form"),
        ("p.fits", b"SIMPLE  =                    T", "FITS file: must be"),
        ("p.psd", b"8BPS\0\1", "Photoshop file: must be"),
        ("p.lfp", b"\x89LFP\r\n\x1a\n", "Lytro light field: must be decoded"),
        ("p.png", b"version https://git-lfs.github.com/spec/v1\n", "Git LFS pointer: must be the file itself"),
        ("p.jpg", b"<!DOCTYPE html>", "a web page: must be an image file"),
        ("p.png", b"", "is empty: must be an image file"),
        ("p.png", b"PK\3\4", "an archive: must be unpacked"),
        ("p.jpg", b"\xff\xd8\xff\xc1\0\x11\x0c\0\x10\0\x10\3", "JPEG of 12 bits: must have 8"),
        ("p.jpg", b"\xff\xd8\xff\xc3\0\x11\x08\0\x10\0\x10\3", "lossless or arithmetic-coded JPEG: must be"),
        ("p.png", b"\0\0\0\x18ftypisom", "a video or sound: must be one picture; talbot sequence"),
        (
            "p.tif",
            lambda path: tifffile.imwrite(path, colours(8), photometric="cielab"),
            "photometric interpretation CIELAB: must be gray, RGB, palette, CMYK",
        ),
        (
            "p.tif",
            lambda path: tifffile.imwrite(path, UNIT.astype(complex), photometric="minisblack"),
            "complex samples: must be real",
        ),
        (
            "p.tif",
            lambda path: tifffile.imwrite(path, (UNIT * 99 - 50).astype(np.int16)),
            r"int16 pixels -\d+..34: must be in 0..32767",
        ),
        (
            "p.tif",
            lambda path: tifffile.imwrite(path, (UNIT * 4e9).astype(np.uint32)),
            r"uint32 pixels .*: must be in 0..65535",
        ),
        (
            "p.tif",
            lambda path: tifffile.imwrite(path, np.zeros((*SHAPE, 5), np.uint8), planarconfig="contig", photometric=1),
            "samples per pixel 5: must be 1 in MINISBLACK, and alpha",
        ),
        ("p.tif", b"II*\0\x08\0\0\0\0\0", "must be an image of 1..178956970 pixels"),
    ],
)
def test_what_is_not_read_is_named(tmp_path, name, write, said):
    path = tmp_path / name
    path.write_bytes(write) if isinstance(write, bytes) else write(path)
    with pytest.raises(ParameterError, match=said) as caught:
        load(str(path), focused(Sampling(16, 24), 0.0))
    assert "\n" not in str(caught.value) and "damaged" not in str(caught.value)


def test_compression_of_imagecodecs_is_named(tmp_path, monkeypatch):
    path = tmp_path / "p.tif"
    tifffile.imwrite(path, UNIT.astype(np.float32), compression="lzw")
    without_imagecodecs(monkeypatch)
    with pytest.raises(ParameterError, match="compressed as LZW: needs the package imagecodecs: pip install"):
        luminance(path)


def test_integers_of_32_bits_are_codes_of_16(tmp_path):
    for dtype in (np.int32, np.uint32):
        tifffile.imwrite(tmp_path / "p.tif", codes(16).astype(dtype))
        np.testing.assert_allclose(luminance(tmp_path / "p.tif"), light(codes(16), 65535), atol=1e-6)


@pytest.mark.parametrize("suffix, deep", [("tif", True), ("png", True), ("png", False)])
def test_a_depth_map_keeps_its_codes(tmp_path, suffix, deep):
    """Codes of 12 bits are millimetres as they are."""
    path = tmp_path / f"d.{suffix}"
    values = codes(12) + 200 if deep else codes(8)
    if suffix == "tif":
        write_tiff(path, "<", 12, 1, SHAPE[0], [packed(codes(12), 12).tobytes()], 1)
        values = codes(12)
    else:
        Image.fromarray(values).save(path)
    np.testing.assert_array_equal(read_codes(path, "depth"), values)


def test_a_coloured_depth_map_is_refused(tmp_path):
    Image.fromarray(colours(8)).save(tmp_path / "d.png")
    with pytest.raises(ParameterError, match="depth = .*colours: must be gray"):
        read_codes(tmp_path / "d.png", "depth")


def test_what_has_holes_or_is_not_turned_as_its_picture_is_told(tmp_path):
    exif = Image.Exif()
    exif[274] = 6
    Image.fromarray(codes(8)).save(tmp_path / "p.png", exif=exif)
    metres = np.full(SHAPE, 2000, np.uint16)
    Image.fromarray(metres).save(tmp_path / "d.png")
    sampling = Sampling(16, 12)
    with pytest.raises(ParameterError, match="proportions .*; turned by the image's EXIF orientation it has"):
        load(str(tmp_path / "p.png"), sampling, depth=str(tmp_path / "d.png"))
    Image.fromarray(metres).save(tmp_path / "d.png", exif=exif)
    assert load(str(tmp_path / "p.png"), sampling, depth=str(tmp_path / "d.png")).depth.shape == (16, 12)
    metres[4, 5] = 0
    Image.fromarray(metres).save(tmp_path / "d.png", exif=exif)
    with pytest.raises(ParameterError, match="depth = 0: .*must be .*; 0 is a hole .*fill"):
        load(str(tmp_path / "p.png"), Sampling(14, 10), depth=str(tmp_path / "d.png"))


def test_pages_are_closed(tmp_path):
    """A file that is refused can be removed, on Windows too."""
    path = tmp_path / "p.tif"
    dng(path)
    with pytest.raises(ParameterError), tiff_file.tiff_pages(path, "scene"):
        pass
    path.unlink()
