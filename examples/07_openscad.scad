// A lantern: a rounded square that turns by 60 degrees on the way up.
linear_extrude(height = 95, twist = 60, slices = 60)
  offset(r = 12, $fn = 64) square(44, center = true);
