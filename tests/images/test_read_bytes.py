"""A picture's bytes, made here of the numbers that the driver holds, are the driver's own."""

import numpy as np

from seethrough.renderer.gpu.device.targets import FrameTarget


def test_every_half_float_becomes_the_byte_that_the_driver_makes_of_it(context):
    """All 65,536 of them, in each of the channels; what is no number aside, which OpenGL leaves
    open, and a tie may go up or down."""
    bits = np.arange(1 << 16, dtype=np.uint16).reshape(256, 256)
    colors = np.stack([bits, bits.T, bits[::-1], bits], axis=2)
    target = FrameTarget(context, (256, 256))
    try:
        target.color.write(np.ascontiguousarray(colors))
        own = target.read()
        data = target.resolved.read(components=3, alignment=1, dtype="f1")
        numbers = np.frombuffer(target.raw(), np.float16).reshape(256, 256, 4)[::-1, :, :3]
    finally:
        target.release()
    drivers = np.frombuffer(data, np.uint8).reshape(256, 256, 3)[::-1]
    number = ~np.isnan(numbers)
    scaled = np.clip(np.where(number, numbers, np.float16(0)).astype(float), 0, 1) * 255
    tie = np.abs(scaled - np.floor(scaled) - 0.5) == 0
    apart = np.abs(own.astype(int) - drivers)
    assert (apart[~tie & number] == 0).all()
    assert (apart[tie] <= 1).all()
    assert (np.abs(own - scaled)[number] <= 0.5).all()
