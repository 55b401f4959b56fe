#!/usr/bin/env python3
"""Writes assets/evening.pfm, the built-in sky: 128 x 64 texels, equirectangular, a clear evening with a low sun.

Python's standard library only; the same bytes on every run and machine.

    make_evening.py [FILE]            write it (default: evening.pfm beside this script)
    make_evening.py --check [FILE]    verify that FILE is what this script writes

Radiance in W/(m^2 sr). The picture's middle is -Z, its right half is on the side of +X. The sun, in the west (-X) and 24
degrees high, gives a surface that faces it 3 W/m^2; the sky gives a floor about as much.
"""

import math
import struct
import sys
from pathlib import Path

WIDTH, HEIGHT = 128, 64
SUN = (-1.0, 24.0)  # azimuth in right angles from -Z towards +X, elevation in degrees
ZENITH, HORIZON, GLOW, GROUND = (0.22, 0.38, 0.75), (0.85, 0.75, 0.65), (2.4, 1.3, 0.5), (0.10, 0.085, 0.07)
SUN_IRRADIANCE = (3.0, 2.3, 1.5)


def mix(a, b, t):
    return tuple(x + (y - x) * t for x, y in zip(a, b))


def direction(azimuth, elevation):
    return (math.cos(elevation) * math.sin(azimuth), math.sin(elevation), -math.cos(elevation) * math.cos(azimuth))


def sky():
    """The rows from the top, without the sun."""
    sun = direction(SUN[0] * math.pi / 2, math.radians(SUN[1]))
    for y in range(HEIGHT):
        elevation = math.pi * (0.5 - (y + 0.5) / HEIGHT)
        row = []
        for x in range(WIDTH):
            d = direction(2 * math.pi * ((x + 0.5) / WIDTH - 0.5), elevation)
            if d[1] < 0:
                row.append(GROUND)
                continue
            near = max(0.0, sum(a * b for a, b in zip(d, sun)))
            color = mix(HORIZON, ZENITH, d[1] ** 0.5)
            row.append(tuple(c + g * (0.25 * near ** 8 + near ** 64) for c, g in zip(color, GLOW)))
        yield row


def picture():
    rows = list(sky())
    # The sun is the one texel that its middle is in.
    x, y = int(WIDTH * (0.5 + SUN[0] / 4)), int(HEIGHT * (0.5 - SUN[1] / 180))
    solid = 2 * math.pi / WIDTH * (math.cos(math.pi * y / HEIGHT) - math.cos(math.pi * (y + 1) / HEIGHT))
    rows[y][x] = tuple(e / solid for e in SUN_IRRADIANCE)
    out = b"PF\n%d %d\n-1.0\n" % (WIDTH, HEIGHT)
    for row in reversed(rows):
        for texel in row:
            # Rounded to what any libm agrees on.
            out += struct.pack("<3f", *(float("%.4g" % v) for v in texel))
    return out


def main():
    check = sys.argv[1:2] == ["--check"]
    names = sys.argv[2:] if check else sys.argv[1:]
    file = Path(names[0]) if names else Path(__file__).with_name("evening.pfm")
    if not check:
        file.write_bytes(picture())
    elif file.read_bytes() != picture():
        sys.exit(f"{file} is not what {Path(__file__).name} writes")


if __name__ == "__main__":
    main()
