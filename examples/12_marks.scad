/* fretwork
[exemplar]
pattern = "girih"
[structure]
material = "PLA"
*/
// A hanging lamp: part, pattern, what stays solid, and what pulls at it, in one file.
use <fretwork.scad>

height = 90;   // [60:150]
foot = 62;     // [40:90]
socket = 40;   // width of the lamp holder, [25:50]
bulb_kg = 0.4; // weight of all that hangs from the socket

module hexagon(width, rounding) {
  offset(r = rounding, $fn = 48) circle(d = width - 2 * rounding, $fn = 6);
}

fretwork_body() hull() {
  linear_extrude(1) hexagon(foot, 6);
  translate([0, 0, 0.45 * height]) linear_extrude(1) hexagon(1.45 * foot, 9);
  translate([0, 0, height - 1]) linear_extrude(1) hexagon(socket + 14, 6);
}

fretwork_keep("foot") translate([0, 0, -1]) cylinder(d = 2 * foot, h = 5);
fretwork_keep("socket") translate([0, 0, height - 1]) cylinder(d = socket, h = 2, $fn = 64);
fretwork_load("bulb", force_n = [0, 0, -9.81 * bulb_kg]) translate([0, 0, height - 1]) cylinder(d = socket, h = 2);
fretwork_fixture("cord") translate([0, 0, height - 1]) cylinder(d = socket / 3, h = 2);
