"""Settings of a node that are ROS 2 parameters."""

from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor, ParameterType, SetParametersResult


class Setting:
    """A parameter of type double that reads like an attribute."""

    def __init__(self, default, low, high, description):
        self.default, self.low, self.high, self.description = default, low, high, description

    def __set_name__(self, owner, name):
        self.name = name

    def __get__(self, settings, owner=None):
        return self if settings is None else settings.node.get_parameter(self.name).value

    def declare(self, node):
        node.declare_parameter(
            self.name,
            self.default,
            descriptor=ParameterDescriptor(
                type=ParameterType.PARAMETER_DOUBLE,
                description=self.description,
                floating_point_range=[FloatingPointRange(from_value=self.low, to_value=self.high)],
            ),
        )


class CircleSettings:
    radius = Setting(1.8, 0.2, 3.0, "radius in metres")
    speed = Setting(1.0, 0.1, 3.0, "speed in metres per second")

    def __init__(self, node):
        self.node = node
        self.radius_setting, self.speed_setting = type(self).radius, type(self).speed
        for setting in (self.radius_setting, self.speed_setting):
            setting.declare(node)
        node.add_on_set_parameters_callback(self.on_set)

    def on_set(self, parameters):
        result = SetParametersResult(successful=True)
        proposed = {p.name: p.value for p in parameters}
        turn = proposed.get("speed", self.speed) / proposed.get("radius", self.radius)
        if turn > 3.0:
            result.successful = False
            result.reason = f"a turn of {turn:.2f} rad/s exceeds 3 rad/s"
        return result
