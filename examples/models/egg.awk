# An egg, 90 mm high, as OFF: awk -f egg.awk > egg.off
BEGIN {
  rings = 48; segments = 96; pi = atan2(0, -1)
  print "OFF"
  print segments * (rings - 1) + 2, 2 * segments * (rings - 1), 0
  for (i = 1; i < rings; ++i)
    for (k = 0; k < segments; ++k) {
      b = pi * i / rings; a = 2 * pi * k / segments
      r = 32 * sin(b) * (1 + 0.16 * cos(b))
      printf "%.5f %.5f %.5f\n", r * cos(a), r * sin(a), 45 - 45 * cos(b)
    }
  print 0, 0, 0
  print 0, 0, 90
  foot = segments * (rings - 1); tip = foot + 1
  for (k = 0; k < segments; ++k) {
    next_k = (k + 1) % segments; last = segments * (rings - 2)
    for (i = 0; i < rings - 2; ++i) {
      low = i * segments; high = low + segments
      print 3, low + k, low + next_k, high + next_k
      print 3, low + k, high + next_k, high + k
    }
    print 3, foot, next_k, k
    print 3, tip, last + k, last + next_k
  }
}
