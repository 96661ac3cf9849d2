// precompile.cpp  A target without a file that uses its precompiled headers gets none: this one does.
#include <catch2/catch.hpp>
