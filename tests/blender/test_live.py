"""Live results: other hours, dates and skies on a transfer that is ready, by frames, by the timer, in renders."""

import math
import threading
import time

import numpy as np
import pytest


@pytest.fixture
def courtyard(addon, bpy, make):
    """A floor beside a wall, clear sky with Sun, solved at 9 h."""
    make.square("Floor", size=2.0, material=make.material("Stone", diffuse_reflectance=0.3))
    make.mesh("Wall", [(0, 2, 0), (2, 2, 0), (2, 2, 3), (0, 2, 3)], [(0, 1, 2, 3)])
    settings = make.quick()
    settings.accuracy.max_area = 0.25
    settings.sky.kind = "CLEAR"
    settings.site.hour = 9.0
    assert bpy.ops.luzespecular.solve() == {"FINISHED"}
    return settings


def means(settings):
    return {(row.name, row.side): row.mean for row in settings.results.rows}


def fine_faces(addon, bpy):
    mesh = addon.results_object.find(bpy.context.scene).data
    return addon.mesh_arrays.read_face_values(mesh, "illuminance", np.float32)


def solved_anew(bpy, settings):
    bpy.ops.luzespecular.solve()
    return means(settings)


def keyframe(settings, group, name, values):
    owner = getattr(settings, group)
    for frame, value in values.items():
        setattr(owner, name, value)
        owner.keyframe_insert(name, frame=frame)


def test_a_run_arms(addon, bpy, courtyard):
    assert addon.live.current.follows(bpy.context.scene)
    courtyard.live = False
    assert not addon.live.current.follows(bpy.context.scene)
    courtyard.live = True
    bpy.ops.luzespecular.clear_results()
    assert not addon.live.current.follows(bpy.context.scene)


def test_frames_show_their_own_hour(addon, bpy, courtyard):
    keyframe(courtyard, "site", "hour", {1: 9.0, 11: 15.0})
    scene = bpy.context.scene
    scene.frame_set(1)
    morning, faces = means(courtyard), fine_faces(addon, bpy)
    scene.frame_set(11)
    assert courtyard.results.title.startswith("2026-06-22, 15:00")
    afternoon = means(courtyard)
    assert afternoon != morning
    assert not np.allclose(fine_faces(addon, bpy), faces)
    assert solved_anew(bpy, courtyard) == pytest.approx(afternoon, rel=1e-3)
    scene.frame_set(1)
    assert means(courtyard) == pytest.approx(morning, rel=1e-3)


@pytest.mark.parametrize(
    ("group", "name", "values"),
    [("site", "days_later", {1: 0, 2: 180}), ("sky", "horizontal_illuminance", {1: 5_000.0, 2: 20_000.0})],
)
def test_date_and_sky_can_be_animated(bpy, courtyard, group, name, values):
    courtyard.sky.illuminance_from = "VALUE"
    courtyard.sky.use_sun = group == "site"
    keyframe(courtyard, group, name, values)
    bpy.context.scene.frame_set(1)
    first = means(courtyard)
    bpy.context.scene.frame_set(2)
    second = means(courtyard)
    assert second == pytest.approx(solved_anew(bpy, courtyard), rel=1e-3)
    if group == "sky":
        assert second == pytest.approx({key: 4 * value for key, value in first.items()}, rel=1e-3)
    else:
        assert second != pytest.approx(first, rel=0.05)


def test_a_frame_in_the_dark_keeps_the_results_and_says_so(addon, bpy, courtyard, caplog):
    before, title = means(courtyard), courtyard.results.title
    keyframe(courtyard, "site", "hour", {1: 9.0, 2: 23.0})
    bpy.context.scene.frame_set(2)
    assert (means(courtyard), courtyard.results.title) == (before, title)
    assert "no light at 23:00" in bpy.context.window_manager.luzespecular.live_remark
    assert "no light" in caplog.text
    bpy.context.scene.frame_set(1)
    assert not bpy.context.window_manager.luzespecular.live_remark


def test_a_render_shows_each_frame_in_its_own_light(addon, bpy, courtyard, tmp_path):
    scene = bpy.context.scene
    keyframe(courtyard, "site", "hour", {1: 9.0, 2: 15.0})
    told = {}

    def remember(at, *_):
        told[at.frame_current] = (courtyard.results.title, means(courtyard))

    bpy.app.handlers.render_post.append(remember)
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.collection.objects.link(camera)
    scene.camera, scene.frame_start, scene.frame_end = camera, 1, 2
    scene.render.engine, scene.cycles.samples = "CYCLES", 1
    scene.render.resolution_x = scene.render.resolution_y = 16
    scene.render.filepath = str(tmp_path / "frame ")
    try:
        bpy.ops.render.render(animation=True)
    finally:
        bpy.app.handlers.render_post.remove(remember)
    assert [told[frame][0][12:17] for frame in (1, 2)] == ["09:00", "15:00"]
    scene.frame_set(2)
    assert told[2][1] == pytest.approx(solved_anew(bpy, courtyard), rel=1e-3)


@pytest.fixture
def dragging(addon, bpy, monkeypatch):
    """Live results as in a window: `drag(hour)`, then `rest()` until all is settled, with time that tests drive."""
    live, now = addon.live.current, [time.monotonic()]
    monkeypatch.setattr(addon.live, "time", type("Clock", (), {"monotonic": staticmethod(lambda: now[0])}))

    class Dragging:
        def drag(self, **changes):
            site = bpy.context.scene.luzespecular.site
            for name, value in changes.items():
                setattr(site, name, value)
            live.want()
            now[0] += 0.05
            while live.advance() and live._job is not None:
                live._job.wait()

        def pass_time(self, seconds):
            now[0] += seconds

        def rest(self):
            self.pass_time(10.0)
            while live.advance():
                if live._job is not None:
                    live._job.wait()

    return Dragging()


def test_a_shade_that_keyframes_move_is_told(addon, bpy, courtyard, caplog):
    wall, scene = bpy.data.objects["Wall"], bpy.context.scene
    for frame, height in ((1, 0.0), (11, 2.0)):
        wall.location.z = height
        wall.keyframe_insert("location", frame=frame)
    scene.frame_set(1)
    bpy.ops.luzespecular.solve()
    assert "Wall: the results are those of frame 1" in courtyard.results.notices[-1].text
    scene.frame_set(1)
    assert addon.live.current.follows(scene)
    addon.live.current.rendering = True
    scene.frame_set(6)
    assert "Wall: the results are those of frame 1" in caplog.text
    addon.live.current.rendering = False
    scene.frame_set(11)
    assert not addon.live.current.follows(scene)
    assert "The scene changed" in caplog.text


def test_objects_renamed_or_gone_while_one_drags_do_no_harm(addon, bpy, courtyard, dragging):
    floor, before = bpy.data.objects["Floor"], means(courtyard)
    floor.name = "Piso"
    bpy.data.objects.remove(bpy.data.objects["Wall"])
    addon.live.current._verified_at = math.inf  # no look at the scene is due
    dragging.drag(hour=10.0)
    assert means(courtyard) != before
    courtyard.display.show_backs = False
    assert floor.hide_get()  # the fine faces stand for it still


def test_dragging_shows_and_rest_settles(addon, bpy, courtyard, dragging):
    dragging.drag(hour=11.0)
    assert courtyard.results.title.startswith("2026-06-22, 11:00")
    quick = means(courtyard)
    assert addon.live.current._quick
    dragging.rest()
    assert not addon.live.current._quick
    settled = means(courtyard)
    assert quick == pytest.approx(settled, rel=0.03)
    assert settled == pytest.approx(solved_anew(bpy, courtyard), rel=1e-4)


def test_a_hand_that_moves_again_need_not_wait_until_all_is_settled(addon, bpy, courtyard, dragging, monkeypatch):
    dragging.drag(hour=11.0)
    live, released = addon.live.current, threading.Event()
    tell = addon.job.Job._tell
    with monkeypatch.context() as slow:
        slow.setattr(addon.job.Job, "_tell", lambda job, *said: released.wait(10.0) and tell(job, *said))
        dragging.pass_time(10.0)
        assert live.advance()
        settling = live._job
        assert not live._quick
        bpy.context.scene.luzespecular.site.hour = 11.5
        live.want()
        assert live.advance()
        released.set()
        settling.wait()
    assert isinstance(settling.error, addon.luz.Cancelled)
    dragging.drag(hour=12.0)
    assert courtyard.results.title.startswith("2026-06-22, 12:00")
    dragging.rest()
    assert not live._quick
    assert not bpy.context.window_manager.luzespecular.live_remark
    assert means(courtyard) == pytest.approx(solved_anew(bpy, courtyard), rel=1e-4)


def test_what_takes_a_moment_is_shown_before_all_is_drawn(addon, bpy, courtyard, dragging):
    live, site = addon.live.current, bpy.context.scene.luzespecular.site
    dragging.drag(hour=11.0)
    live._seconds = 0.0
    for hour, title in ((10.0, "10:00"), (10.5, "10:30")):
        site.hour = hour
        live.want()
        live._seconds = 0.0
        live.begin_at_once()
        if live._job is not None:  # a machine at work on other things
            live._job.wait()
            live.advance()
        assert title in courtyard.results.title
    live._seconds = 60.0
    site.hour = 9.5
    live.want()
    live.begin_at_once()
    assert "10:30" in courtyard.results.title  # to be shown by the timer, however soon it is done
    assert live._job is not None
    running = live._job
    live.begin_at_once()
    assert live._job is running  # one at a time
    running.wait()
    live.advance()
    assert "09:30" in courtyard.results.title


def test_while_dragging_the_scene_is_looked_at_now_and_then(addon, bpy, courtyard, dragging, monkeypatch):
    looks = []
    is_current = addon.study.is_current
    monkeypatch.setattr(addon.study, "is_current", lambda *args: looks.append(1) or is_current(*args))
    dragging.pass_time(10.0)
    dragging.drag(hour=9.5)  # 0.05 s each
    assert len(looks) == 1
    for step in range(10):
        dragging.drag(hour=10.0 + 0.1 * step)
    assert len(looks) == 1
    for step in range(10):
        dragging.drag(hour=11.0 + 0.1 * step)
    assert len(looks) == 2
    dragging.rest()
    assert len(looks) > 3  # what stays is looked at before and after


def test_a_changed_scene_stops_it_and_says_so(addon, bpy, courtyard, dragging):
    title = courtyard.results.title
    bpy.data.objects["Wall"].location.x = 0.5
    bpy.context.view_layer.update()
    dragging.rest()  # so long ago that the scene is looked at again
    dragging.drag(hour=11.0)
    assert courtyard.results.title == title
    assert "The scene changed" in bpy.context.window_manager.luzespecular.live_remark
    assert not addon.live.current.follows(bpy.context.scene)


def test_a_rested_scene_is_settled_only_if_it_still_stands(addon, bpy, courtyard, dragging):
    dragging.drag(hour=11.0)
    bpy.data.objects["Wall"].location.x = 0.5
    bpy.context.view_layer.update()
    dragging.rest()
    assert "The scene changed" in bpy.context.window_manager.luzespecular.live_remark


def test_deleted_objects_do_no_harm(addon, bpy, courtyard, dragging):
    bpy.data.objects.remove(bpy.data.objects["Wall"])
    dragging.rest()
    dragging.drag(hour=11.0)
    assert not addon.live.current.follows(bpy.context.scene)


def test_dragging_into_the_night_says_so_and_back_again(addon, bpy, courtyard, dragging):
    dragging.drag(hour=22.0)
    assert "no light at 22:00" in bpy.context.window_manager.luzespecular.live_remark
    dragging.drag(hour=10.0)
    assert courtyard.results.title.startswith("2026-06-22, 10:00")
    assert not bpy.context.window_manager.luzespecular.live_remark


def test_another_file_is_not_followed(addon, bpy, courtyard):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    assert addon.live.current.scene is None


def test_time_left(addon):
    left = addon.job.seconds_left
    assert left(0.5, 0.5) is None
    assert left(10.0, 0.01) is None
    assert left(10.0, 0.25) == pytest.approx(30.0)
    assert left(10.0, 1.0) == 0.0
