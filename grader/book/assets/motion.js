// The motion of the turtle for the figures, with the rules of the simulator (grader/turtlesim/turtle.py). A test
// compares the two motions.

export const SIDE_M = 11.088889122009277;
export const FRAME_S = 0.016;
export const START = { x: 5.544445, y: 5.544445, theta: 0 };

// Return the angle in the range from -π to π.
export function normalize(angle) {
  return Math.atan2(Math.sin(angle), Math.cos(angle));
}

// Return the pose one frame later, at v m/s and w rad/s. The turtle first turns and then moves. The walls limit x and y.
// `wall` is true if the turtle hits a wall.
export function step({ x, y, theta }, v, w) {
  const turned = normalize(theta + w * FRAME_S);
  const wanted = { x: x + Math.cos(turned) * v * FRAME_S, y: y + Math.sin(turned) * v * FRAME_S };
  const clamp = (value) => Math.min(Math.max(value, 0), SIDE_M);
  const next = { x: clamp(wanted.x), y: clamp(wanted.y), theta: turned };
  return { ...next, wall: next.x !== wanted.x || next.y !== wanted.y };
}

// Return the poses of a drive that lasts the given number of seconds.
export function drive(start, v, w, seconds) {
  const poses = [start];
  for (let frame = 0; frame < Math.round(seconds / FRAME_S); frame += 1) poses.push(step(poses[poses.length - 1], v, w));
  return poses;
}

// Return the point `ahead` metres in front of the turtle and `left` metres to its left, in the world frame.
export function toWorld({ x, y, theta }, ahead, left) {
  return {
    x: x + Math.cos(theta) * ahead - Math.sin(theta) * left,
    y: y + Math.sin(theta) * ahead + Math.cos(theta) * left,
  };
}

// Return the distance and the direction of a goal, and the angle by which the turtle must turn to face it.
export function errors({ x, y, theta }, goal) {
  const [dx, dy] = [goal.x - x, goal.y - y];
  const direction = Math.atan2(dy, dx);
  return { dx, dy, distance: Math.hypot(dx, dy), direction, turn: normalize(direction - theta) };
}
