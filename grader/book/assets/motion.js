// How the turtle moves: the rules of the simulator (grader/turtlesim/turtle.py), for the figures. A test compares them.

export const SIDE_M = 11.088889122009277;
export const FRAME_S = 0.016;
export const START = { x: 5.544445, y: 5.544445, theta: 0 };

// The same angle in the range from -π to π.
export function normalize(angle) {
  return Math.atan2(Math.sin(angle), Math.cos(angle));
}

// The pose one frame later, at v m/s and w rad/s: the turtle turns first, then it moves. Walls stop it.
export function step({ x, y, theta }, v, w) {
  const turned = normalize(theta + w * FRAME_S);
  const wanted = { x: x + Math.cos(turned) * v * FRAME_S, y: y + Math.sin(turned) * v * FRAME_S };
  const clamp = (value) => Math.min(Math.max(value, 0), SIDE_M);
  const next = { x: clamp(wanted.x), y: clamp(wanted.y), theta: turned };
  return { ...next, wall: next.x !== wanted.x || next.y !== wanted.y };
}

// The poses from the start to the end of a drive of so many seconds.
export function drive(start, v, w, seconds) {
  const poses = [start];
  for (let frame = 0; frame < Math.round(seconds / FRAME_S); frame += 1) poses.push(step(poses[poses.length - 1], v, w));
  return poses;
}

// A point that is `ahead` metres before the turtle and `left` metres to its left, in the frame of the world.
export function toWorld({ x, y, theta }, ahead, left) {
  return {
    x: x + Math.cos(theta) * ahead - Math.sin(theta) * left,
    y: y + Math.sin(theta) * ahead + Math.cos(theta) * left,
  };
}

// How far a goal is, in which direction it lies, and how far the turtle has to turn to face it.
export function errors({ x, y, theta }, goal) {
  const [dx, dy] = [goal.x - x, goal.y - y];
  const direction = Math.atan2(dy, dx);
  return { dx, dy, distance: Math.hypot(dx, dy), direction, turn: normalize(direction - theta) };
}
