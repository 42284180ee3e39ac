"""A window where there is a screen, and plain words where there is none."""

import sys

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

from slipgym.rendering import Window
from slipgym.screen import obstacle


@pytest.fixture
def no_screen(monkeypatch):
    pytest.importorskip("pygame")
    monkeypatch.setattr(sys, "platform", "linux")
    for name in ("DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER"):
        monkeypatch.delenv(name, raising=False)


def test_the_window_shows_each_thirtieth_of_a_second(make, hidden_screen, monkeypatch):
    shown = []
    monkeypatch.setattr(Window, "show", lambda self, picture, rate: shown.append(picture))
    env = make(render_mode="human")
    env.reset(seed=0)
    assert len(shown) == 1
    for _ in range(12):
        env.step(np.float32([0.0]))
    assert len(shown) == 4
    assert env.render() is None
    np.testing.assert_array_equal(shown[-1], shown[-2])


def test_what_is_shown_is_the_picture(hidden_screen):
    import pygame

    window = Window("test", (720, 480))
    picture = np.random.default_rng(0).integers(0, 255, (480, 720, 3), dtype=np.uint8)
    window.show(picture, 1000.0)
    on_screen = pygame.surfarray.array3d(pygame.display.get_surface())
    np.testing.assert_array_equal(on_screen.swapaxes(0, 1), picture)
    pygame.event.post(pygame.event.Event(pygame.QUIT))
    window.show(picture, 1000.0)
    assert window.closed
    assert window.vertical() == 0
    window.close()


def test_without_a_screen_the_error_says_what_to_do(make, no_screen):
    with pytest.raises(RuntimeError, match=r"there is no screen.*rgb_array.*--video"):
        make(render_mode="human")


def test_without_pygame_the_error_says_what_to_install(make, hidden_screen, monkeypatch):
    monkeypatch.setattr("slipgym.screen.find_spec", lambda name: None)
    with pytest.raises(RuntimeError, match=r"pip install 'slipgym\[window\]'"):
        make(render_mode="human")


def test_the_checker_passes_with_and_without_a_screen(make, env_id, hidden_screen, monkeypatch):
    env = make(env_id)
    assert "human" in env.metadata["render_modes"]
    check_env(env)
    monkeypatch.setattr("slipgym.screen.find_spec", lambda name: None)
    env = make(env_id)
    assert "human" not in env.metadata["render_modes"]
    check_env(env)


def test_gymnasiums_own_window(env_id, hidden_screen):
    env = gym.wrappers.HumanRendering(
        gym.make(env_id, render_mode="rgb_array", frame_skip=4, action_mode="grip_force")
    )
    env.reset(seed=0)
    env.step(np.float32([0.0]))
    assert env.render() is None
    env.close()


def test_a_hidden_screen_is_no_obstacle(hidden_screen):
    assert obstacle() == ""
