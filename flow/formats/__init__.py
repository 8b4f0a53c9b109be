"""Token formats and scan orders for the byte stream, measured: bytes, and gates of the encoder."""
