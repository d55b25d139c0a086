# A shelf bracket as OFF: awk -f bracket.awk > bracket.off
# The wall is at x = 0, the board lies on z = 80; between them a quarter of a circle is taken out of an 80 mm square.
BEGIN {
  width = 40; arc = 32; pi = atan2(0, -1)
  x[0] = 0; z[0] = 80; x[1] = 0; z[1] = 0; n = 2
  for (i = 0; i <= arc; ++i) { a = pi - pi / 2 * i / arc; x[n] = 80 + 68 * cos(a); z[n] = 68 * sin(a); ++n }
  x[n] = 80; z[n] = 80; ++n
  print "OFF"
  print 2 * n, 2 * (n - 2) + n, 0
  for (side = 0; side < 2; ++side) for (i = 0; i < n; ++i) printf "%.5f %.5f %.5f\n", x[i], width * side, z[i]
  for (i = 1; i < n - 1; ++i) { print 3, 0, i, i + 1; print 3, n, n + i + 1, n + i }
  for (i = 0; i < n; ++i) { j = (i + 1) % n; print 4, j, i, n + i, n + j }
}
