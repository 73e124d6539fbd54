"""What can be seen, from layers made by hand."""

from __future__ import annotations

import numpy as np

from seethrough.renderer.scene.visibility import SEEN, shares, visibility


def layer(ids, alpha):
    """From pictures of object + 1 and of the opacity."""
    ids, alpha = np.ravel(ids), np.ravel(alpha).astype(float)
    where = np.nonzero(ids)[0]
    return where, ids[where], alpha[where]


def test_shares_are_what_the_layers_in_front_leave():
    """Object 1 opaque behind object 2 at .3 behind object 3 at .5: .35, .15, .5."""
    layers = [layer([[1, 1]], [[1, 1]]), layer([[2, 0]], [[0.3, 1]]), layer([[3, 0]], [[0.5, 1]])]
    which, pixel, share = shares(layers, 2)
    found = {(int(i), int(p)): s for i, p, s in zip(which, pixel, share, strict=True)}
    assert found == {(0, 0): 0.35, (1, 0): 0.15, (2, 0): 0.5, (0, 1): 1.0}


def test_what_shows_with_less_than_a_sixty_fourth_is_not_seen():
    """Nobody could see it: no pixel, no position, no weight."""
    layers = [layer([[1]], [[1]]), layer([[2]], [[1 - SEEN / 2]])]
    seen = visibility(layers, np.zeros((1, 1, 3), np.uint8), 2)
    assert seen.pixels.tolist() == [0, 1]
    assert seen.visible.tolist() == [False, True]
    assert seen.weight[0] == 0
    assert np.isnan(seen.position[0]).all()


def test_position_area_and_contrast_of_a_square():
    """A white square of 2 × 2 pixels in black 4 × 6: its middle in view units, contrast 1."""
    ids = np.zeros((4, 6), int)
    ids[1:3, 3:5] = 1
    picture = np.where(ids[..., None] > 0, 255, 0).astype(np.uint8).repeat(3, axis=2)
    seen = visibility([layer(ids, np.ones((4, 6)))], picture, 1)
    assert seen.pixels.tolist() == [4]
    np.testing.assert_allclose(seen.position, [[4 / 4, 2 / 4]])
    np.testing.assert_allclose(seen.area, [4 / 24])
    np.testing.assert_allclose(seen.contrast, [1.0])


def test_contrast_is_to_the_rest_of_a_box_half_as_large_again():
    """A grey square, off the middle of a picture of noise: its surround added up pixel by pixel."""
    rng = np.random.default_rng(6)
    picture = rng.integers(0, 256, (40, 60, 3)).astype(np.uint8)
    ids = np.zeros((40, 60), int)
    ids[20:28, 33:45] = 1
    picture[ids > 0] = 90
    seen = visibility([layer(ids, np.ones((40, 60)))], picture, 1)
    box = np.zeros((40, 60), bool)
    box[18:30, 31:47] = True  # a margin of two pixels, the least, or of a quarter
    surround = picture[box & (ids == 0)].mean(axis=0)
    expected = np.linalg.norm(surround - 90) / 255 / np.sqrt(3)
    np.testing.assert_allclose(seen.contrast, [expected], rtol=1e-12)
