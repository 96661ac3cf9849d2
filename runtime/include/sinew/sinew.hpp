// sinew.hpp  Everything public in one include.
#pragma once
#include "sinew/contact_source.hpp"
#include "sinew/id.hpp"
#include "sinew/isa.hpp"
#include "sinew/parameters.hpp"
#include "sinew/status.hpp"
#include "sinew/types.hpp"
#include "sinew/world.hpp"
