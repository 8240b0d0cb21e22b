"""Inside a real Blender window: run the steps of a file from a timer, so that the window lives on between them.

Started by ``tools/gui.py``: ``blender … --python tests/gui/driver.py -- steps.py folder``. A file of steps defines
``steps(window)``, a generator that yields the seconds to wait before it goes on; an assertion that fails ends Blender
with status 1.
"""

import os
import runpy
import shutil
import subprocess
import sys
import time
import traceback
from pathlib import Path

import bpy

PACKAGE = "bl_ext.user_default.luzespecular"
TAB = "LuzEspecular"


class Window:
    """Blender's first window, as a user's hands and eyes have it."""

    def __init__(self, folder):
        self.folder = folder
        self.pauses = []  # seconds between looks at the clock: how long the window stood still
        self.work = []  # of those, processor time of Blender's main thread, whatever else the machine does
        bpy.context.preferences.view.show_splash = False
        bpy.context.preferences.view.show_developer_ui = True

    @property
    def window(self):
        return bpy.context.window_manager.windows[0]

    def area(self, kind="VIEW_3D"):
        return next(area for area in self.window.screen.areas if area.type == kind)

    def region(self, kind="WINDOW", area="VIEW_3D"):
        return next(region for region in self.area(area).regions if region.type == kind)

    def override(self, region="WINDOW", area="VIEW_3D"):
        """Context of a region, for operators."""
        return bpy.context.temp_override(window=self.window, area=self.area(area), region=self.region(region, area))

    def open_tab(self):
        """Open the sidebar and its tab, wide enough for all texts: steps."""
        self.area().spaces.active.show_region_ui = True
        yield 0.5
        sidebar = self.region("UI")
        sidebar.active_panel_category = TAB
        sidebar.tag_redraw()
        yield 0.5

    def press(self, key, x=None, y=None, value=None):
        """Press and release a key or button, over the middle of the 3D view unless told where."""
        area = self.area()
        x = area.x + area.width // 2 if x is None else x
        y = area.y + area.height // 2 if y is None else y
        for kind in ("PRESS", "RELEASE") if value is None else (value,):
            self.window.event_simulate(type=key, value=kind, x=round(x), y=round(y))

    def move(self, x, y):
        """Move the mouse."""
        self.window.event_simulate(type="MOUSEMOVE", value="NOTHING", x=round(x), y=round(y))

    def hovered(self, area="VIEW_3D", region="UI"):
        """The name of the property under the mouse."""
        with self.override(region, area):
            found = bpy.context.property
        return None if found is None else found[1].rpartition(".")[2]

    def find(self, name, found, area="VIEW_3D", region="UI"):
        """Move over a region from top to bottom until a property lies under the mouse: steps.

        The place is appended to ``found``.
        """
        place = self.region(region, area)
        x = place.x + 0.7 * place.width
        for patience in (0.1, 0.6):  # a busy machine notices late where the mouse is
            for y in range(place.y + place.height - 8, place.y + 8, -12):
                self.move(x, y)
                yield patience
                if self.hovered(area, region) == name:
                    found.append((x, y))
                    return
        raise AssertionError(f"no property '{name}' in sight")

    def scroll(self, area="VIEW_3D", region="UI", down=True, times=60):
        """Scroll a region to its end or its beginning, or some way there: steps."""
        with self.override(region, area):
            for _ in range(times):
                (bpy.ops.view2d.scroll_down if down else bpy.ops.view2d.scroll_up)(deltax=0, deltay=120)
        self.area(area).tag_redraw()
        yield 0.8

    def shot(self, name):
        """A picture of the whole screen as a PNG; Blender's own is black on software drivers, so X's goes first."""
        path = self.folder / f"{name}.png"
        if shutil.which("import") and os.environ.get("DISPLAY"):
            subprocess.run(["import", "-window", "root", str(path)], check=True)
        else:
            with self.override():
                bpy.ops.screen.screenshot(filepath=str(path))
        print("picture", path, flush=True)
        return path

    def until(self, done, seconds=60.0, pause=0.1):
        """Wait until something holds: steps."""
        end = time.monotonic() + seconds
        while not done():
            assert time.monotonic() < end, f"waited {seconds} s in vain"
            yield pause

    def clock(self):
        """Note how long the window stands still at most, from now on: look at ``pauses`` and ``work``."""
        self.pauses.clear()
        self.work.clear()
        last = [time.perf_counter(), time.thread_time()]

        def tick():
            now = [time.perf_counter(), time.thread_time()]
            self.pauses.append(now[0] - last[0])
            self.work.append(now[1] - last[1])
            last[:] = now
            return 0.005

        bpy.app.timers.register(tick)
        return lambda: bpy.app.timers.unregister(tick)


def main():
    steps, folder = sys.argv[sys.argv.index("--") + 1 :][:2]
    sys.path.insert(0, str(Path(steps).parent))
    generator = runpy.run_path(steps)["steps"](Window(Path(folder)))

    def tick():
        try:
            return max(float(next(generator)), 0.01)
        except StopIteration:
            print("all steps done", flush=True)
            status = 0
        except BaseException:
            traceback.print_exc()
            status = 1
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)

    bpy.app.timers.register(tick, first_interval=1.5, persistent=True)


if __name__ == "__main__":  # steps import what stands above
    main()
