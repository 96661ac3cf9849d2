# newer TARGET SOURCE...: true when the target is there and no source is newer. To be sourced.
newer() {
  local target=$1 source
  shift
  [ -e "$target" ] || return 1
  for source in "$@"; do [ "$source" -nt "$target" ] && return 1; done
  return 0
}
