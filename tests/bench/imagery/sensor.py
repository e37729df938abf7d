"""From light to numbers: blur, vignetting, step at seams, haze, noise, colour cast, tone, sharpening."""
import numpy as np


def blurred(a, sigma):
    """Gaussian along rows and columns; a (rows, columns[, 3]) float32."""
    if sigma <= 0:
        return a
    n = int(np.ceil(3 * sigma))
    k = np.exp(-.5 * (np.arange(-n, n + 1) / sigma)**2)
    k /= k.sum()
    for axis in (0, 1):
        padded = np.pad(a, [(n, n) if i == axis else (0, 0) for i in range(a.ndim)], mode="edge")
        a = sum(w * np.take(padded, range(i, i + a.shape[axis]), axis) for i, w in enumerate(k)).astype(np.float32)
    return a


def develop(light, frame_of, radial, gains, p, rng):
    """light (rows, columns, 3) linear; frame_of (rows, columns) number of the frame; radial: distance from the middle of the frame,
    0..1; gains (frames, 3). Returns uint8 (rows, columns, 3)."""
    light = blurred(light, p["blur"])
    light *= gains[frame_of] * (1 - p["vignetting"] * radial**2)[..., None]
    light = light * p["exposure"] * np.array(p["cast"], np.float32) + np.array(p["haze"], np.float32)
    light += rng.standard_normal(light.shape).astype(np.float32) * p["noise"] * np.sqrt(np.clip(light, .02, 1))
    if p["sharpen"]:
        light += p["sharpen"] * (light - blurred(light, 1.2))
    light = np.clip(light, 0, 1)
    c = np.where(light <= .0031308, light * 12.92, 1.055 * light**(1 / 2.4) - .055)
    grey = c.mean(-1, keepdims=True)
    c = grey + (c - grey) * p["saturation"]
    c = .5 + (c - .5) * p["contrast"]
    return (np.clip(c, 0, 1) * 255 + .5).astype(np.uint8)
