# Shell helpers of board/vm: the drivers that Debian's kernel lacks, built out of tree against its headers.

build_modules() { # RELEASE WORK MODULES
  local work=$2 build=$2/usr/src/linux-headers-$1 name
  prepare_gpio_sim "$work"
  prepare_vkms "$work"
  prepare_rotary_encoder "$work"
  mkdir -p "$work/out/v4l2loopback" "$3/updates"
  cp "$work"/usr/src/v4l2loopback-*/* "$work/out/v4l2loopback/"
  for name in gpio-sim vkms v4l2loopback rotary-encoder; do
    make -C "$build" M="$work/out/$name" -j2 modules
    cp "$work/out/$name"/*.ko "$3/updates/"
  done
}

# gpio-sim with its interrupt simulator in one module: the kernel exports neither irq_sim nor irq_to_desc.
prepare_gpio_sim() { # WORK
  local out=$1/out/gpio-sim
  mkdir -p "$out"
  cp "$1"/sources/drivers/gpio/*.h "$out/"
  cp "$1/sources/drivers/gpio/gpio-sim.c" "$out/lines.c"
  sed 's/handle_simple_irq(irq_to_desc(irqnum))/generic_handle_irq_safe(irqnum)/' \
    "$1/sources/kernel/irq/irq_sim.c" >"$out/interrupts.c"
  printf 'obj-m := gpio-sim.o\ngpio-sim-y := lines.o interrupts.o\n' >"$out/Kbuild"
}

prepare_vkms() { # WORK
  mkdir -p "$1/out"
  cp -r "$1/sources/drivers/gpu/drm/vkms" "$1/out/vkms"
  sed -i 's/\$(CONFIG_DRM_VKMS)/m/' "$1/out/vkms/Makefile"
}

# The driver, and what a cart's device tree would say of its encoder.
prepare_rotary_encoder() { # WORK
  local out=$1/out/rotary-encoder
  mkdir -p "$out"
  cp "$1/sources/drivers/input/misc/rotary_encoder.c" "$VM_DIR/drivers/rotary_lines.c" "$out/"
  printf 'obj-m := rotary_encoder.o rotary_lines.o\n' >"$out/Kbuild"
}
