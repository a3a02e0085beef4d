# Linear algebra of balances and modes.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
target_link_libraries(${target} PRIVATE Eigen3::Eigen)

# Vectors of motion in time, for whatever instruction set the machine has.
find_package(hwy 1.0 REQUIRED NO_MODULE)
target_link_libraries(${target} PRIVATE hwy::hwy)
