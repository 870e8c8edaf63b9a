"""Force feedback in SOFA, from Python: a controller gives the force of a Palpate object to a GeomagicDriver.

    from palpate_force_feedback import PalpateForceFeedback
    import palpate

    def createScene(root):
        driver = root.addObject("GeomagicDriver", maxInputForceFeedback=3)
        skin = palpate.Object.scene({"cloud": "sample:skin"})
        root.addObject(PalpateForceFeedback(skin, driver))

SofaPython3 lets Python write controllers, not components of SOFA's class ForceFeedback, which the driver asks a thousand times
a second in its own thread. So this force is held for a step of the animation, and the governor, which sees how far apart the
ticks are, softens the object accordingly: at 100 Hz a wall has a tenth of maximum_stiffness. For all of it, at 1 kHz, there
is palpate_force_feedback.h beside this file.
"""

import math
import threading
import time
import weakref

import Sofa.Core

SILENCE = 50e-3  # [s] after a step, after which its force ends


def watch(touch, stepped):
    """Ends the force once there was no step for 50 ms: the animation pauses or is slow, and the driver would hold it."""
    while True:
        is_fresh = stepped.wait(SILENCE)
        stepped.clear()
        own = touch()
        if own is None:
            return
        if not is_fresh:
            own.let_go()
        del own


class PalpateForceFeedback(Sofa.Core.Controller):
    """object: a palpate.Object in metres. driver: a GeomagicDriver. metres: in a unit of SOFA's scene; the driver's own are
    centimetres. maximum_stiffness: of a wall that the device renders stably at 1 kHz [N/m]. surface: what has `position`,
    such as an OglModel, with the points of the object; None: nothing is drawn."""

    def __init__(self, object, driver, metres=0.01, maximum_stiffness=1000.0, surface=None):
        Sofa.Core.Controller.__init__(self)
        self.driver, self.metres, self.surface = driver, metres, surface
        self.session = object.session(maximum_force=driver.maxInputForceFeedback.value,
                                      maximum_stiffness=maximum_stiffness)
        self.last = None  # time [s] and position [m]
        self.stepped = threading.Event()
        threading.Thread(target=watch, args=(weakref.ref(self), self.stepped), daemon=True).start()

    def let_go(self):
        self.driver.inputForceFeedback.value = [0.0, 0.0, 0.0]

    def onAnimateBeginEvent(self, event):
        try:
            self.step()
        except BaseException:
            self.let_go()
            raise

    def step(self):
        self.stepped.set()
        now, position = time.monotonic(), [self.metres * float(x) for x in self.driver.positionDevice.value[:3]]
        before, place = self.last or (now, position)
        velocity = [(p - q) / (now - before) if now > before else 0.0 for p, q in zip(position, place)]
        if all(map(math.isfinite, position)):
            self.last = now, position
        answer = self.session.step(now, position, velocity, buttons=int(bool(self.driver.button1.value)))
        self.driver.inputForceFeedback.value = answer.force.tolist()
        points = self.session.deformed() if self.surface else None
        if points is not None:
            self.surface.position.value = points / self.metres
