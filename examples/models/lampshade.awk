# A lampshade without top and bottom, 90 mm high, as OFF: awk -f lampshade.awk > lampshade.off
BEGIN {
  rings = 40; segments = 96; pi = atan2(0, -1)
  print "OFF"
  print segments * (rings + 1), 2 * segments * rings, 0
  for (i = 0; i <= rings; ++i)
    for (k = 0; k < segments; ++k) {
      t = i / rings; a = 2 * pi * k / segments
      r = 22 + 30 * (1 - t) ^ 1.4 + 5 * sin(pi * t)
      printf "%.5f %.5f %.5f\n", r * cos(a), r * sin(a), 90 * t
    }
  for (k = 0; k < segments; ++k)
    for (i = 0; i < rings; ++i) {
      next_k = (k + 1) % segments; low = i * segments; high = low + segments
      print 3, low + k, low + next_k, high + next_k
      print 3, low + k, high + next_k, high + k
    }
}
