"""A study's own scene, from a file."""

from seethrough.tasks.worlds.scene.scene_world import SceneWorld

WORLD = SceneWorld()
