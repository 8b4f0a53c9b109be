"""The byte stream that leaves the chip: golden encoder, decoder, and the command that decodes a file."""

from talbot.models.digital.stream.decode import decode_stream, iterate_frames
from talbot.models.digital.stream.encode import encode_frame, encode_marked, encode_payload, segments, whole_bytes
from talbot.models.digital.stream.file import decode_file
from talbot.models.digital.stream.frame import DecodedFrame
from talbot.models.digital.stream.header import StreamError, StreamHeader

__all__ = [
    "DecodedFrame",
    "StreamError",
    "StreamHeader",
    "decode_file",
    "decode_stream",
    "encode_frame",
    "encode_marked",
    "encode_payload",
    "iterate_frames",
    "segments",
    "whole_bytes",
]
