class Controller:
    """What SOFA calls at events; like the real one it has to be initialised."""

    def __init__(self, *arguments, **settings):
        self.initialised = True


class Data:
    def __init__(self, value):
        self.value = value
