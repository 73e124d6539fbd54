"""Dear ImGui on our own overlay: one context, fed with our events, drawn into any framebuffer."""

from __future__ import annotations

import ctypes
from pathlib import Path

import imgui_bundle
import moderngl
import numpy as np
from imgui_bundle import imgui

from seethrough.renderer.gpu.overlay import STRIDE, Batch, Overlay

REGULAR = "Roboto-Regular.ttf"
FONTS = Path(imgui_bundle.__file__).parent / "assets" / "fonts" / "Roboto"
INSET_TEXTURES = 1 << 20  # names from here on are pictures of ours, below are ImGui's

KEYS = {
    "left": imgui.Key.left_arrow,
    "right": imgui.Key.right_arrow,
    "up": imgui.Key.up_arrow,
    "down": imgui.Key.down_arrow,
    "enter": imgui.Key.enter,
    "space": imgui.Key.space,
    "backspace": imgui.Key.backspace,
    "delete": imgui.Key.delete,
    "tab": imgui.Key.tab,
    "home": imgui.Key.home,
    "end": imgui.Key.end,
    "shift": imgui.Key.left_shift,
    "a": imgui.Key.a,
    "c": imgui.Key.c,
    "v": imgui.Key.v,
    "x": imgui.Key.x,
    "z": imgui.Key.z,
}

# Screens that a key scrolls a page on. ImGui's own way jumps from button to button over the text.
SCREENS = {"pagedown": 0.85, "pageup": -0.85}
LINES = {"down": 0.25, "up": -0.25}  # where there is nothing but text to move over


def has_glyph(character: str) -> bool:
    """Whether the font that texts are drawn in has a picture of a character."""
    before = imgui.get_current_context()
    own = imgui.create_context()
    try:
        imgui.set_current_context(own)
        font = imgui.get_io().fonts.add_font_from_file_ttf(str(FONTS / REGULAR), 20.0)
        return bool(font.is_glyph_in_font(ord(character)))
    finally:
        if before is not None:
            imgui.set_current_context(before)
        imgui.destroy_context(own)


class Interface:
    """What lies flat on the screen: `begin`, draw with imgui, `end`."""

    def __init__(self, context: moderngl.Context) -> None:
        self.overlay = Overlay(context)
        self._imgui = imgui.create_context()
        imgui.set_current_context(self._imgui)
        self.io = imgui.get_io()
        self.io.set_ini_filename("")
        self.io.backend_flags |= imgui.BackendFlags_.renderer_has_textures
        self.io.config_flags |= imgui.ConfigFlags_.nav_enable_keyboard
        self.regular = self.io.fonts.add_font_from_file_ttf(str(FONTS / REGULAR), 20.0)
        self.reading = False  # the page is text that is longer than the screen
        self.scroll = 0.0  # screens to scroll on
        self.bold = self.io.fonts.add_font_from_file_ttf(str(FONTS / "Roboto-Bold.ttf"), 20.0)
        _style()

    def begin(self, size: tuple[int, int], passed: float) -> None:
        """Start a frame of `size` pixels, `passed` seconds after the last one."""
        imgui.set_current_context(self._imgui)
        self.io.display_size = imgui.ImVec2(*size)
        self.io.delta_time = max(passed, 1e-4)
        imgui.new_frame()

    def end(self, target: moderngl.Framebuffer) -> None:
        """Draw what was put between `begin` and `end` into `target`."""
        imgui.render()
        for texture in imgui.get_platform_io().textures:
            self._update(texture)
        for commands in imgui.get_draw_data().cmd_lists:
            vertices = ctypes.string_at(
                commands.vtx_buffer.data_address(), commands.vtx_buffer.size() * STRIDE
            )
            raw = ctypes.string_at(
                commands.idx_buffer.data_address(),
                commands.idx_buffer.size() * imgui.INDEX_SIZE,
            )
            kind = np.uint16 if imgui.INDEX_SIZE == 2 else np.uint32
            indices = np.frombuffer(raw, kind).astype(np.uint32)
            batches = [_batch(command) for command in commands.cmd_buffer]
            self.overlay.draw(target, vertices, indices, batches)

    def _update(self, texture: imgui.ImTextureData) -> None:
        status, want = texture.status, imgui.ImTextureStatus
        if status == want.want_create:
            name = texture.unique_id + 1  # 0 means "no texture" to ImGui
            pixels = texture.get_pixels_array()
            self.overlay.create_texture(name, (texture.width, texture.height), pixels.tobytes())
            texture.set_tex_id(name)
            texture.set_status(want.ok)
        elif status == want.want_updates:
            pixels = texture.get_pixels_array().reshape(texture.height, texture.width, 4)
            for r in texture.updates:
                part = np.ascontiguousarray(pixels[r.y : r.y + r.h, r.x : r.x + r.w])
                self.overlay.update_texture(texture.get_tex_id(), part, (r.x, r.y))
            texture.set_status(want.ok)
        elif status == want.want_destroy and texture.unused_frames > 0:
            self.overlay.delete_texture(texture.get_tex_id())
            texture.set_tex_id(0)
            texture.set_status(want.destroyed)

    def key(self, name: str, down: bool) -> None:
        """A key of renderer/events.py; those that forms do not use are ignored."""
        scroll = {**SCREENS, **LINES} if self.reading else SCREENS
        if name in scroll:
            self.scroll += scroll[name] if down else 0.0
        elif name in KEYS:
            self.io.add_key_event(KEYS[name], down)
        if name == "shift":
            self.io.add_key_event(imgui.Key.mod_shift, down)

    def close(self) -> None:
        """Free the ImGui context."""
        imgui.destroy_context(self._imgui)


def _style() -> None:
    """Calm and light; sizes come from the screen's height when a page is drawn."""
    imgui.style_colors_light()
    style = imgui.get_style()
    style.window_border_size = 0
    style.frame_border_size = 1
    colors = {
        imgui.Col_.window_bg: (0.97, 0.97, 0.98, 1),
        imgui.Col_.text: (0.10, 0.11, 0.13, 1),
        imgui.Col_.text_disabled: (0.38, 0.40, 0.44, 1),
        imgui.Col_.frame_bg: (1, 1, 1, 1),
        imgui.Col_.border: (0.62, 0.65, 0.70, 1),
        imgui.Col_.button: (0.16, 0.40, 0.70, 1),
        imgui.Col_.button_hovered: (0.22, 0.48, 0.80, 1),
        imgui.Col_.button_active: (0.12, 0.32, 0.58, 1),
        imgui.Col_.check_mark: (0.16, 0.40, 0.70, 1),
        imgui.Col_.nav_cursor: (0, 0, 0, 0),  # page_blocks.ring draws one that grows with the text
    }
    for which, value in colors.items():
        style.set_color_(which, imgui.ImVec4(*value))


def _batch(command: imgui.ImDrawCmd) -> Batch:
    left, top, right, bottom = command.clip_rect
    return Batch(
        command.tex_ref.get_tex_id(),
        command.idx_offset,
        command.elem_count,
        command.vtx_offset,
        (left, top, right, bottom),
    )
