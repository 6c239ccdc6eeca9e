"""Colours of a playback, RRGGBBAA: a palette of distinct ones, and a scale for the curvature."""

import numpy as np

# Okabe and Ito 2008, for colour-blind readers; grey and brown instead of its yellow and black, which
# would not show on white or beside the arm.
PALETTE = np.array(
    [0x0072B2FF, 0xD55E00FF, 0x009E73FF, 0xE69F00FF, 0xCC79A7FF, 0x56B4E9FF, 0x8C8C8CFF, 0x8C5A3CFF],
    dtype=np.uint32,
)
BLACK, GREY, LIGHT_GREY, PURPLE, GREEN, WHITE = (
    0x000000FF,
    0x8C8C8CFF,
    0xC8C8C8FF,
    0xCC79A7FF,
    0x009E73FF,
    0xFFFFFFFF,
)

# ColorBrewer's RdBu of 11 classes, turned round (Harrower and Brewer 2003): diverging, and for
# colour-blind readers, too.
_DIVERGING = np.array(
    [
        (0x05, 0x30, 0x61),
        (0x21, 0x66, 0xAC),
        (0x43, 0x93, 0xC3),
        (0x92, 0xC5, 0xDE),
        (0xD1, 0xE5, 0xF0),
        (0xF7, 0xF7, 0xF7),
        (0xFD, 0xDB, 0xC7),
        (0xF4, 0xA5, 0x82),
        (0xD6, 0x60, 0x4D),
        (0xB2, 0x18, 0x2B),
        (0x67, 0x00, 0x1F),
    ],
    dtype=float,
)
_TINT = 0.6
"""Largest part of white in the shades of a colour."""


def diverging(values: np.ndarray, most: float) -> np.ndarray:
    """Red, green, blue (uint8, shape (..., 3)): blue at -``most``, white at 0, red at ``most``."""
    place = np.clip(0.5 + 0.5 * values / most, 0.0, 1.0) * (len(_DIVERGING) - 1)
    known = np.arange(len(_DIVERGING))
    channels = [np.interp(place, known, channel) for channel in _DIVERGING.T]
    return np.stack(channels, axis=-1).round().astype(np.uint8)


def pack(rgb: np.ndarray) -> np.ndarray:
    """Opaque RRGGBBAA of red, green, blue, shape (..., 3)."""
    red, green, blue = np.moveaxis(rgb.astype(np.uint32), -1, 0)
    return (red << 24) | (green << 16) | (blue << 8) | np.uint32(0xFF)


def distinct_colors(count: int) -> np.ndarray:
    """``count`` colours of the palette."""
    return PALETTE[np.arange(count) % len(PALETTE)]


def shades(color: int, count: int) -> np.ndarray:
    """A colour and lighter shades of it, for the series of one run."""
    rgb = np.array([color >> 24 & 0xFF, color >> 16 & 0xFF, color >> 8 & 0xFF], dtype=float)
    white = np.linspace(0.0, _TINT, count)[:, None]
    return pack((rgb + white * (255.0 - rgb)).round())
