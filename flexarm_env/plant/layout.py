"""Places of all quantities in the flat arrays that the kernel reads and writes.

The kernel takes four arrays and no more, because numba pays for each array at each call: constants d (float64), counts
and places n (int64), the state s (float64) and scratch w (float64).
"""

# --- n: counts, places within one mode's record in d, lists of active laws. STEADY_BODIES is the number of bodies if no force
# varies, else 0; STEP_TABLES are tables of event-free steps or, with drag, of the forces' influence
BODIES, COORDINATES, COUPLED, VARYING, POINTS, BLOCKS, SIGNALS, STATES, MODES, STRIDE = range(10)
EARLY_SUBSTEPS, LATE_SUBSTEPS, DRIVERS = 10, 11, 12
C0, C1, RESPONSES, PHYSICAL, MODAL, FORCING, FORCE_COLUMNS, SPEED, SPEED_WEIGHT, ANGLE, HOLDS_ANGLE = range(13, 24)
WINDUP, WINDUP_WEIGHT, HOLD, HOLD_WEIGHT, HOLD_DRIVERS, HOLD_FORCES, DRAG_VELOCITY = range(24, 31)
OUTPUT, OUTPUT_DRIVERS = 31, 32
FRICTION_LAWS, TORQUE_LAWS, DRAG_LAWS, DRIVE_LAWS, PARAMETERS, STEADY_BODIES, QUIET_TABLE, STEP_TABLES = range(33, 41)
MESH, MESH_WEIGHT, SENSOR_LAWS, FACTOR_LAWS, PRESLIDING_LAWS, WEIGHT_LAWS, RAMP_LAWS, SPRING_LAWS = range(41, 49)
# body on which the hub's sensors are; how the drive's torque depends on the motion
HUB_BODY, DRIVE_FEEDBACK = 49, 50
# coordinate of the tip's deflection; -1 of a rigid arm
TIP = 51
COUNTS = 52

# --- values of DRIVE_FEEDBACK: not at all, by back-EMF, by a servo's loop besides, up to limits
NO_FEEDBACK, OPPOSED, PROPORTIONAL, LIMITED = range(4)

# --- one block's numbers in QUIET_TABLE: C, S, R₀, S + c₁ R₀, c₀, c₁, the tested row's chord error per amplitude, that row's two
# numbers, the forcing by command, hub torque, 1, held hub, two each
Q_C, Q_S, Q_R0, Q_S_R0, Q_C0, Q_C1, Q_BEND, Q_ROW = range(8)
Q_COMMAND, Q_HUB, Q_ONE, Q_HELD = 9, 11, 13, 15
QUIET_SIZE = 17

# --- d: single constants, before the modes' records. *_FRICTION_SHARE is the sum over the friction laws of the shares that act on
# the body; the motor's follows the hub's, so that HUB_FRICTION_SHARE + body is a body's
GAP, TOLERANCE, INTERVAL, EARLY_LENGTH, LATE_LENGTH, HUB_FRICTION_SHARE, MOTOR_FRICTION_SHARE, GEAR_RATIO = range(8)
# torque in the gears per windup, per its rate, and of rigid ones per command
LOAD_STIFFNESS, LOAD_DAMPING, LOAD_BY_COMMAND = range(8, 11)
# of a drive with feedback: voltage by command, by angle and by speed; torque by voltage; back-EMF by speed, arm side;
# limits of the voltage and of the voltage across the armature; supply voltage, and its resistance over the armature's
VOLTAGE_BY_COMMAND, VOLTAGE_BY_ANGLE, VOLTAGE_BY_SPEED, TORQUE_BY_VOLTAGE, BACK_EMF = range(11, 16)
LARGEST_VOLTAGE, LARGEST_DROP, SUPPLY_VOLTAGE, SUPPLY_SHARE = range(16, 20)
# linear friction of hub and motor where an effect changes it, else 0
HUB_VISCOUS, MOTOR_VISCOUS = 20, 21
CONSTANTS = 22

# --- s: the state; friction's memory of the hub's angle and its torque there; the drive's output before COMMAND, from which it
# may still ramp; block coordinates z from Z_START on. The motor's place follows the hub's, so that HUB_DIRECTION + body and
# HELD_HUB + body are a body's
MODE, HUB_DIRECTION, MOTOR_DIRECTION, GEAR_SIDE, HELD_HUB, HELD_MOTOR, TIME, COMMAND = range(8)
KNOWN_ANGLE, KNOWN_FRICTION, EARLIER = 8, 9, 10
Z_START = 11

# --- columns of the drivers
W_COMMAND, W_HUB, W_MOTOR, W_ONE, W_SIDE, W_HELD_HUB, W_HELD_MOTOR = range(7)
