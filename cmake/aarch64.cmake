# Cross-builds for 64-bit Arm with Debian's compiler and its libraries of the foreign architecture (scripts/install_packages.sh
# aarch64), and runs what it built in QEMU.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)  # of the same architecture: what CMake finds for one it finds for all
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64)
