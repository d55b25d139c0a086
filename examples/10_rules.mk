# Carved models as targets of make; the .d files name every file that was read.
PATTERNS := leafveins scales
all: $(PATTERNS:%=$(OUT)/10_%.3mf)
$(OUT)/10_vase.off: models/vase.awk
	awk -f $< > $@
$(OUT)/10_%.3mf: $(OUT)/10_vase.off
	$(FRETWORK) carve $< --pattern ./vase.toml -D exemplar.pattern=$* -p 10_sets.json -P wide \
	  --resolution $(RESOLUTION) -o $@ -d $(@:.3mf=.d)
-include $(wildcard $(OUT)/10_*.d)
