"""The two messages, with ROS 2's rule that a field holds its own type only."""


class _Message:
    fields = {}

    def __init__(self, **values):
        for name, kind in self.fields.items():
            object.__setattr__(self, name, kind())
        for name, value in values.items():
            setattr(self, name, value)

    def __setattr__(self, name, value):
        if type(value) is not self.fields[name]:
            raise AssertionError(f"{type(self).__name__}.{name}: expected {self.fields[name]}, found {value!r}")
        object.__setattr__(self, name, value)


def _message(name, **fields):
    return type(name, (_Message,), {"fields": fields})


_Time = _message("Time", sec=int, nanosec=int)
_Header = _message("Header", stamp=_Time, frame_id=str)
_Vector3 = _message("Vector3", x=float, y=float, z=float)
_Quaternion = _message("Quaternion", x=float, y=float, z=float, w=float)
_Pose = _message("Pose", position=_Vector3, orientation=_Quaternion)
_Wrench = _message("Wrench", force=_Vector3, torque=_Vector3)
PoseStamped = _message("PoseStamped", header=_Header, pose=_Pose)
WrenchStamped = _message("WrenchStamped", header=_Header, wrench=_Wrench)
