// Marks on an OpenSCAD part for Fretwork: what stays solid, what is carved, where it is pushed and held.
//
//     use <fretwork.scad>
//     fretwork_body() difference() { cylinder(r = 30, h = 90); translate([0, 0, -1]) cylinder(r = 8, h = 20); }
//     fretwork_keep("foot") cylinder(r = 40, h = 6);
//     fretwork_load("top", force_n = [0, 0, -50]) translate([0, 0, 85]) cylinder(r = 40, h = 9);
//     fretwork_fixture("table") translate([0, 0, -1]) cylinder(r = 40, h = 2);
//
//     fretwork carve part.scad --pattern cells -o part.3mf
//
// Marks are volumes. What of the part's surface lies inside one, or on its faces, is marked. OpenSCAD itself shows
// them as see-through shapes and leaves them out when it renders. Marks of one kind and name are one mark.
// Names hold letters, digits, _ and -.

// The part itself: all of it that is to be carved or kept stands in this.
module fretwork_body() {
  if (is_undef($fretwork) || $fretwork == "body") children();
}

// Stays solid.
module fretwork_keep(name = "keep") {
  _fretwork_mark("keep", name, []) children();
}

// Is carved; with any of these, only they are, and all else stays solid.
module fretwork_carve(name = "carve") {
  _fretwork_mark("carve", name, []) children();
}

// Is pushed. force_n is the total force [x, y, z] in newton over the marked surface, pressure_mpa a pressure into it.
// Loads of one case act together; each case is looked at on its own.
module fretwork_load(name = "load", force_n = [0, 0, 0], pressure_mpa = 0, case = "load") {
  assert(is_list(force_n) && len(force_n) == 3 && is_num(norm(force_n)),
         str("fretwork_load(\"", name, "\"): force_n = ", force_n, "; expected three numbers, in newton"));
  assert(is_num(pressure_mpa),
         str("fretwork_load(\"", name, "\"): pressure_mpa = ", pressure_mpa, "; expected a number, in megapascal"));
  assert(norm(force_n) > 0 || pressure_mpa != 0,
         str("fretwork_load(\"", name, "\"): needs force_n or pressure_mpa"));
  _fretwork_check_name("fretwork_load: case", case);
  _fretwork_mark("loads", name, [force_n[0], force_n[1], force_n[2], pressure_mpa, case]) children();
}

// Cannot move. With a case, it holds in that one only.
module fretwork_fixture(name = "fixture", case = "") {
  if (case != "") _fretwork_check_name("fretwork_fixture: case", case);
  _fretwork_mark("fixtures", name, [case]) children();
}

// Fretwork asks for one thing at a time through $fretwork: "body", or "KIND:NAME" of a mark. When it asks for the
// body, the marks say what there is.
module _fretwork_mark(kind, name, values) {
  _fretwork_check_name(str("fretwork_", kind, ": name"), name);
  if (is_undef($fretwork)) %children();
  else if ($fretwork == "body") echo(fretwork = concat([kind, name], values));
  else if ($fretwork == str(kind, ":", name)) children();
}

module _fretwork_check_name(what, name) {
  allowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  assert(is_string(name) && len(name) > 0 && len([for (c = name) if (len(search(c, allowed)) == 0) c]) == 0,
         str(what, " = ", name, "; expected text of letters, digits, _ and -"));
}
