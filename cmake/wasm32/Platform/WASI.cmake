# CMake asks for a file of each system's name; there is nothing to say of this one.
