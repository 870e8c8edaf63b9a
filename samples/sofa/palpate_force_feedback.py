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
import time

import Sofa.Core


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

    def onAnimateBeginEvent(self, event):
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
