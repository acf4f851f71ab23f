"use strict";
// The player shows the turtle at a time and advances the time. The page is complete without this script.
function replay(run, view) {
  function find(name) { return view.querySelector("." + name); }
  if (run.t.length < 2) return;
  var turtle = find("turtle"), gone = find("gone"), player = find("player");
  var play = find("play"), time = find("slider"), speed = find("speed"), now = find("now");
  var heads = Array.prototype.slice.call(view.querySelectorAll(".head"));
  var canvas = run.canvas;
  var at = run.end, last = null;

  // The last index whose time is not after t.
  function index(times, t) {
    var low = 0, high = times.length - 1;
    while (low < high) {
      var middle = (low + high + 1) >> 1;
      if (times[middle] <= t) low = middle; else high = middle - 1;
    }
    return low;
  }

  // The path as one string and its length at each frame: the path up to a time is then a slice of the string.
  var points = "", ends = [], px = [], py = [];
  for (var i = 0; i < run.t.length; i++) {
    var known = run.x[i] !== null && run.y[i] !== null;
    px.push(known ? canvas.left + run.x[i] * canvas.scale : null);
    py.push(known ? canvas.bottom - run.y[i] * canvas.scale : null);
    var same = i > 0 && px[i] === px[i - 1] && py[i] === py[i - 1];
    if (known && !same) points += px[i].toFixed(1) + "," + py[i].toFixed(1) + " ";
    ends.push(points.length);
  }
  var commandTimes = run.commands.map(function (command) { return command[0]; });

  function said(value, unit) {
    return value === null ? "not a number" : value.toFixed(2) + " " + unit;
  }

  function show(t) {
    at = Math.min(Math.max(t, 0), run.end);
    var i = index(run.t, at);
    var known = px[i] !== null && run.theta[i] !== null;
    turtle.setAttribute("visibility", known ? "visible" : "hidden");
    if (known) {
      var degrees = (-run.theta[i] * 180 / Math.PI).toFixed(1);
      turtle.setAttribute("transform", "translate(" + px[i].toFixed(1) + " " + py[i].toFixed(1) + ") rotate(" + degrees + ")");
    }
    gone.setAttribute("points", at < run.end ? points.slice(0, ends[i]) : "");
    heads.forEach(function (head) {
      head.setAttribute("visibility", at < run.end ? "visible" : "hidden");
      head.setAttribute("transform", "translate(" + (run.across * at / run.end).toFixed(1) + " 0)");
    });
    var text = at.toFixed(2) + " s: ";
    text += known ? "x " + said(run.x[i], "m") + ", y " + said(run.y[i], "m") + ", heading " + said(run.theta[i], "rad")
      : "the pose is not a number";
    if (commandTimes.length && commandTimes[0] <= at) {
      var command = run.commands[index(commandTimes, at)];
      text += "; last command: linear.x " + said(command[1], "m/s") + ", angular.z " + said(command[2], "rad/s");
    } else {
      text += "; no command yet";
    }
    var made = run.calls.filter(function (call) { return call[0] <= at; });
    if (made.length) text += "; at " + made[made.length - 1][0].toFixed(2) + " s " + made[made.length - 1][1];
    now.textContent = text;
    time.value = String(at);
    time.setAttribute("aria-valuetext", at.toFixed(1) + " of " + run.end.toFixed(1) + " seconds");
  }

  function stop() {
    last = null;
    play.textContent = "Play";
  }

  function tick(stamp) {
    if (last === null) return;
    if (last !== 0) show(at + (stamp - last) / 1000 * Number(speed.value));
    last = stamp;
    if (at >= run.end) stop(); else requestAnimationFrame(tick);
  }

  play.addEventListener("click", function () {
    if (last !== null) { stop(); return; }
    if (at >= run.end) show(0);
    last = 0;
    play.textContent = "Pause";
    requestAnimationFrame(tick);
  });
  time.addEventListener("input", function () { show(Number(time.value)); });

  time.max = String(run.end);
  player.hidden = false;
  show(run.end);
}
