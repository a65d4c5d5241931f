// Nothing of its own: what is precompiled needs a target, see CMakeLists.txt.
