# Shell helpers of board/vm: Debian's own kernels, unpacked beside the machine's and never installed.

# kernel_release FLAVOUR: what the meta package names now, else the newest that is in the cache. FLAVOUR: plain or rt.
kernel_release() {
  local meta=linux-image-amd64 suffix=amd64 named
  [ "$1" != rt ] || meta=linux-image-rt-amd64 suffix=rt-amd64
  named=$(apt-cache depends "$meta" 2>/dev/null | sed -n 's/^ *Depends: linux-image-\([0-9].*\)$/\1/p' | head -n 1)
  [ -n "$named" ] || named=$(cached_releases | grep -E -- "-[0-9]+-$suffix\$" | sort -V | tail -n 1)
  [ -n "$named" ] || cannot "apt does not know $meta (apt-get update would tell), and no such kernel is in $VM_CACHE"
  printf '%s\n' "$named"
}

cached_releases() { find "$VM_CACHE" -mindepth 2 -maxdepth 2 -name ready -printf '%h\n' 2>/dev/null | sed 's|.*/||'; }

# How it is laid out and what is built here out of tree: a change of either makes the kernel be set up again.
recipe() { { echo layout 2 && cat "$VM_DIR/lib/modules.sh" "$VM_DIR"/drivers/*; } | sha256sum | cut -c 1-16; }

# set_up_kernel FLAVOUR: prints the folder with vmlinux, initramfs and lib/modules; made where it is not there yet.
set_up_kernel() {
  local release folder
  release=$(kernel_release "$1") || {
    printf '%s\n' "$release"
    exit "$VM_CANNOT"
  }
  folder=$VM_CACHE/$release
  mkdir -p "$VM_CACHE"
  exec 8>"$folder.lock"
  flock 8
  if [ "$(cat "$folder/ready" 2>/dev/null)" != "$(recipe)" ]; then
    say "setting up Linux $release in $folder"
    unpack_kernel "$release" "$folder" >"$VM_CACHE/$release.log" 2>&1 || {
      tail -n 5 "$VM_CACHE/$release.log" >&2
      cannot "Linux $release could not be set up; all that was said: $VM_CACHE/$release.log"
    }
    recipe >"$folder/ready"
  fi
  [ "$folder/initramfs" -nt "$VM_DIR/guest/init" ] || make_initramfs "$release" "$folder"
  exec 8>&-
  printf '%s\n' "$folder"
}

unpack_kernel() ( # RELEASE FOLDER
  set -euo pipefail
  release=$1 folder=$2
  work=$folder.work
  rm -rf "$folder" "$work"
  mkdir -p "$folder" "$work"
  cd "$work"
  fetch_packages "$release"
  for package in *.deb; do dpkg -x "$package" .; done
  unpack_sources "$release"
  bash sources/scripts/extract-vmlinux "boot/vmlinuz-$release" >"$folder/vmlinux"
  mkdir -p "$folder/lib"
  mv lib/modules "$folder/lib/modules"
  prune_modules "$folder/lib/modules/$release/kernel"
  build_modules "$release" "$work" "$folder/lib/modules/$release"
  mkdir "$folder/udev"
  mv lib/udev lib/systemd usr bin "$folder/udev/" 2>/dev/null || true
  rm -rf "$folder/udev/usr/src" "$folder/udev/usr/share" "$folder/udev/usr/lib/linux-kbuild-6.1"
  depmod -b "$folder" "$release"
  rm -rf "$work"
)

# The headers' version is the image's own; their common part and the tools to build with go by the same number.
fetch_packages() { # RELEASE
  local release=$1 common=${1%-amd64} version flavour=''
  [[ $common != *-rt ]] || flavour=-rt
  version=$(apt-cache policy "linux-image-$release" | sed -n 's/^ *Candidate: //p')
  apt-get -qq download "linux-image-$release=$version" "linux-headers-$release=$version" \
    "linux-headers-${common%-rt}-common$flavour=$version" "linux-kbuild-6.1=$version" "linux-source-6.1=$version" \
    v4l2loopback-dkms udev
}

unpack_sources() { # RELEASE
  mkdir sources
  tar -C sources --strip-components=1 -I 'xz -T0' -xf usr/src/linux-source-6.1.tar.xz --wildcards \
    'linux-source-6.1/scripts/extract-vmlinux' 'linux-source-6.1/drivers/gpio/gpio-sim.c' \
    'linux-source-6.1/drivers/gpio/*.h' 'linux-source-6.1/drivers/input/misc/rotary_encoder.c' 'linux-source-6.1/kernel/irq/irq_sim.c' 'linux-source-6.1/drivers/gpu/drm/vkms/*'
  # Debian's headers name their other half by its place in an installed system.
  find usr/src usr/lib -type f \( -name Makefile -o -name '.kernelvariables' \) -exec \
    sed -i "s|/usr/src/linux-headers|$PWD/usr/src/linux-headers|g; s|/usr/lib/linux-kbuild|$PWD/usr/lib/linux-kbuild|g" {} +
}

# Three quarters of the modules are network cards, file systems and sound cards that no guest of ours has.
prune_modules() { # FOLDER
  rm -rf "$1"/drivers/{net,infiniband,scsi,ata,nvme,staging,isdn,hwmon,iio,nvdimm,mtd,md,target,vfio,xen,hv} \
    "$1"/drivers/gpu/drm/{amd,i915,nouveau,radeon,gma500,vmwgfx,ast,mgag200,qxl} \
    "$1"/drivers/media/{dvb-frontends,pci,tuners,radio,usb/dvb*} \
    "$1"/sound "$1"/fs/{xfs,btrfs,ocfs2,nfs,nfsd,cifs,ksmbd,ceph,gfs2,f2fs,jfs,reiserfs,ubifs,afs,dlm} \
    "$1"/net/{bluetooth,mac80211,wireless,netfilter,ipv4,ipv6,sctp,tipc,sched,batman-adv,can,openvswitch,sunrpc}
}

# The early userspace: busybox, the few modules that reach the host's files, and guest/init.
make_initramfs() { # RELEASE FOLDER
  local release=$1 folder=$2 root module file
  root=$(mktemp -d)
  mkdir -p "$root"/{bin,lib,proc,sys,dev,lower,upper,root,share}
  cp "$(command -v busybox)" "$root/bin/busybox"
  cp "$VM_DIR/guest/init" "$root/init"
  chmod 755 "$root/init"
  for module in virtio_pci 9pnet_virtio 9p overlay; do
    modprobe -d "$folder" -S "$release" --show-depends "$module"
  done | awk '$1 == "insmod" && !seen[$2]++ { print $2 }' | while read -r file; do
    cp "$file" "$root/lib/"
    basename "$file" >>"$root/lib/order"
  done
  (cd "$root" && find . | cpio --quiet -o -H newc | gzip -1) >"$folder/initramfs"
  rm -rf "$root"
}
