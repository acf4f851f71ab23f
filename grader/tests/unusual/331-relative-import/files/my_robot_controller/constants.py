SPEED = 2.0  # m/s
PERIOD = 1 / 2  # s
