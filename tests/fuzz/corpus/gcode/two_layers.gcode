; external perimeters extrusion width = 0.45mm
G90
M83
;TYPE:Perimeter
;LAYER_CHANGE
;Z:0.2
;HEIGHT:0.2
G1 X5 Y5 F900
G1 X9 Y5 E.5
;Z:0.6
G1 Z.6
G1 X9 Y9 E1e-1
G92 E0
G91
G1 X-1 E1
; estimated printing time (normal mode) = 1h 2m 3s
; bed_shape = 0x0,50x0,50x40
; max_print_height = 30
