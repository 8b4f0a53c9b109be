"""Energy of the chip's events, measured at the gates of its layout: frames that vary one thing each, and a fit."""
