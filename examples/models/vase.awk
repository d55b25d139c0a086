# An open vase, 100 mm high, as OFF: awk -f vase.awk > vase.off
BEGIN {
  rings = 48; segments = 96; pi = atan2(0, -1)
  print "OFF"
  print segments * (rings + 1) + 1, segments * (2 * rings + 1), 0
  for (i = 0; i <= rings; ++i)
    for (k = 0; k < segments; ++k) {
      t = i / rings; a = 2 * pi * k / segments
      r = 27 - 4 * t + 9 * sin(2.2 * pi * t + 0.15)
      printf "%.5f %.5f %.5f\n", r * cos(a), r * sin(a), 100 * t
    }
  print 0, 0, 0
  for (k = 0; k < segments; ++k) {
    next_k = (k + 1) % segments
    for (i = 0; i < rings; ++i) {
      low = i * segments; high = low + segments
      print 3, low + k, low + next_k, high + next_k
      print 3, low + k, high + next_k, high + k
    }
    print 3, segments * (rings + 1), next_k, k
  }
}
