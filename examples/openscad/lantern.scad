/* fretwork
[exemplar]
image = "../02_leaves.png"
width_mm = 45
[structure]
material = "PETG"
*/
// A lantern with a solid foot. The sets of sets.json make three of it.
use <fretwork.scad>

sides = 6;    // [3:12]
height = 70;  // [30:150]
width = 50;   // [30:90]
twist = 40;   // [0:120]

fretwork_body()
  linear_extrude(height, twist = twist, slices = height / 2)
    offset(r = width / 8, $fn = 40) circle(d = 0.75 * width, $fn = sides);
fretwork_keep("foot") translate([0, 0, -1]) cylinder(d = 2 * width, h = 4);
